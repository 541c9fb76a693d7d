// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "expression.hpp"

#include <muParser.h>

#include <array>
#include <atomic>
#include <cctype>
#include <charconv>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "pgdr/error.hpp"

namespace pgdr::tool {
namespace {

constexpr std::array<const char*, 3> variables{"x", "y", "z"};
using ParserError = mu::Parser::exception_type;

[[noreturn]] void refuse(const std::string& text, const std::string& flag, const std::string& why) {
  throw UsageError({.code = Errc::bad_option, .message = flag + " \"" + text + "\": " + why});
}

/// muParser's own has pow() for every exponent but those of a bare variable; a square is what sizes are made of.
double power(double base, double exponent) { return exponent == 2 ? base * base : std::pow(base, exponent); }

double hypotenuse(const double* legs, int count) {
  if (count == 2) return std::hypot(legs[0], legs[1]);
  if (count == 3) return std::hypot(legs[0], legs[1], legs[2]);
  throw ParserError("hypot has two or three arguments");
}

double either(double condition, double if_true, double if_false) { return condition != 0 ? if_true : if_false; }

/// An "=" that assigns: muParser would give the variable another value.
bool assigns(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') {
      ++i;
      continue;
    }
    if (i == 0 || (text[i - 1] != '<' && text[i - 1] != '>' && text[i - 1] != '!')) return true;
  }
  return false;
}

/// A parser and the variables it reads.
template <int D>
class Evaluator {
 public:
  explicit Evaluator(const std::string& text) {
    for (int i = 0; i < D; ++i) parser_.DefineVar(variables[static_cast<std::size_t>(i)], &at_[i]);
    parser_.DefineOprt(power_sign, power, mu::prPOW, mu::oaRIGHT, true);
    parser_.DefineFun("pow", power);
    parser_.DefineFun("hypot", hypotenuse);
    parser_.DefineFun("if", either);
    parser_.ClearConst();  // _pi and _e
    parser_.DefineConst("pi", std::numbers::pi);
    parser_.SetExpr(text);
  }
  double at(const Point<D>& p) {
    at_ = p;
    return parser_.Eval();
  }
  bool constant() const { return parser_.GetUsedVar().empty(); }
  int values() const { return parser_.GetNumResults(); }  ///< of the last evaluation: commas separate several

  /// What is wrong: an unknown name with those that there are, or muParser's words.
  std::string explain(const ParserError& e) const {
    const std::string& word = e.GetToken();
    const bool is_name = e.GetCode() == mu::ecUNASSIGNABLE_TOKEN && !word.empty() &&
                         (std::isalpha(static_cast<unsigned char>(word[0])) != 0 || word[0] == '_');
    if (!is_name) return e.GetMsg() + " (variables: " + variable_names() + ")";
    if (parser_.GetFunDef().count(word) > 0) return "the function \"" + word + "\" has its arguments in parentheses";
    std::string functions;
    for (const auto& [name, function] : parser_.GetFunDef()) functions += (functions.empty() ? "" : ", ") + name;
    return "there is no \"" + word + "\". Variables: " + variable_names() + "; constant: pi; functions: " + functions;
  }

  static constexpr const char* power_sign = "**";

 private:
  static std::string variable_names() { return D == 2 ? "x, y" : "x, y, z"; }

  Point<D> at_{};
  mu::Parser parser_;
};

template <int D>
class Expression {
 public:
  Expression(std::string text, std::string flag) : text_(std::move(text)), flag_(std::move(flag)) {
    if (assigns(text_)) refuse(text_, flag_, "a single \"=\" would be an assignment; equal is \"==\"");
    int values = 1;
    Evaluator<D> evaluator(text_);
    try {
      evaluator.at({});  // compiles: names and syntax are decided here
      constant_ = evaluator.constant();
      values = evaluator.values();
    } catch (const ParserError& e) {
      refuse(text_, flag_, evaluator.explain(e));
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
    } catch (const ParserError& e) {
      refuse(text_, flag_, e.GetMsg());
    }
  }

 private:
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
