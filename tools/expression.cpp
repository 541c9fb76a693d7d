// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "expression.hpp"

#include <muParser.h>

#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <memory>
#include <vector>

#include "pgdr/error.hpp"

namespace pgdr::tool {
namespace {

constexpr std::array<const char*, 3> variables{"x", "y", "z"};

[[noreturn]] void refuse(const std::string& text, const std::string& flag, const std::string& why) {
  throw UsageError({.code = Errc::bad_option, .message = flag + " \"" + text + "\": " + why});
}

/// muParser's own has pow() for every exponent but those of a bare variable; a square is what sizes are made of.
double power(double base, double exponent) { return exponent == 2 ? base * base : std::pow(base, exponent); }

/// A parser and the variables it reads.
template <int D>
class Evaluator {
 public:
  explicit Evaluator(const std::string& text) {
    for (int i = 0; i < D; ++i) parser_.DefineVar(variables[static_cast<std::size_t>(i)], &at_[i]);
    parser_.DefineOprt(power_sign, power, mu::prPOW, mu::oaRIGHT, true);
    parser_.SetExpr(text);
  }
  double at(const Point<D>& p) {
    at_ = p;
    return parser_.Eval();
  }
  bool constant() const { return parser_.GetUsedVar().empty(); }
  int values() const { return parser_.GetNumResults(); }  ///< of the last evaluation: commas separate several

  static constexpr const char* power_sign = "**";

 private:
  Point<D> at_{};
  mu::Parser parser_;
};

template <int D>
class Expression {
 public:
  Expression(std::string text, std::string flag) : text_(std::move(text)), flag_(std::move(flag)) {
    int values = 1;
    try {
      Evaluator<D> evaluator(text_);
      evaluator.at({});  // compiles: names and syntax are decided here
      constant_ = evaluator.constant();
      values = evaluator.values();
    } catch (const mu::Parser::exception_type& e) {
      refuse(text_, flag_, explain(e));
    }
    if (values != 1) refuse(text_, flag_, "these are " + std::to_string(values) + " values; a decimal point is no comma");
    for (std::size_t i = text_.find('^'); i != std::string::npos; i = text_.find('^', i + 1))
      text_.replace(i, 1, Evaluator<D>::power_sign);
  }

  bool constant() const { return constant_; }

  /// Each thread has an evaluator of its own for each expression of the command.
  double operator()(const Point<D>& p) const {
    thread_local std::vector<std::unique_ptr<Evaluator<D>>> evaluators;
    try {
      if (evaluators.size() <= id_) evaluators.resize(id_ + 1);
      auto& evaluator = evaluators[id_];
      if (!evaluator) evaluator = std::make_unique<Evaluator<D>>(text_);
      return evaluator->at(p);
    } catch (const mu::Parser::exception_type& e) {
      refuse(text_, flag_, explain(e));
    }
  }

 private:
  static std::string explain(const mu::Parser::exception_type& e) {
    return e.GetMsg() + (D == 2 ? " (variables: x, y)" : " (variables: x, y, z)");
  }
  static std::size_t next_id() {
    static std::atomic<std::size_t> ids{0};
    return ids++;
  }

  std::string text_, flag_;
  std::size_t id_ = next_id();
  bool constant_ = false;
};

}  // namespace

template <int D>
SizingField<D> parse_size(const std::string& text, const std::string& flag) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  bool constant = error == std::errc() && end == text.data() + text.size();
  std::shared_ptr<Expression<D>> expression;
  if (!constant) {
    expression = std::make_shared<Expression<D>>(text, flag);
    constant = expression->constant();
    if (constant) value = (*expression)({});
  }
  if (!constant) return [expression](const Point<D>& p) { return (*expression)(p); };
  if (!(value > 0)) refuse(text, flag, "a size must be positive");
  return value;
}

template SizingField<2> parse_size<2>(const std::string&, const std::string&);
template SizingField<3> parse_size<3>(const std::string&, const std::string&);

}  // namespace pgdr::tool
