// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "expression.hpp"

#include <muParser.h>

#include <array>
#include <atomic>
#include <charconv>
#include <memory>
#include <new>
#include <thread>

#include "pgdr/error.hpp"

namespace pgdr::tool {
namespace {

constexpr std::array<const char*, 3> variables{"x", "y", "z"};

[[noreturn]] void refuse(const std::string& text, const std::string& flag, const std::string& why) {
  throw UsageError({.code = Errc::bad_option, .message = flag + " \"" + text + "\": " + why});
}

/// One parser and the variables it reads; owned by the call that set `busy`.
template <int D>
struct alignas(64) Slot {
  std::atomic_flag busy;
  Point<D> at;
  std::unique_ptr<mu::Parser> parser;  // made by the first call that comes here

  void compile(const std::string& text) {
    auto made = std::make_unique<mu::Parser>();
    for (int i = 0; i < D; ++i) made->DefineVar(variables[static_cast<std::size_t>(i)], &at[i]);
    made->SetExpr(text);
    parser = std::move(made);
  }
};

template <int D>
class Expression {
 public:
  Expression(std::string text, std::string flag) : text_(std::move(text)), flag_(std::move(flag)) {
    try {
      slots_[0].compile(text_);
      slots_[0].parser->Eval();  // compiles: names and syntax are decided here
      constant_ = slots_[0].parser->GetUsedVar().empty();
    } catch (const mu::Parser::exception_type& e) {
      refuse(text_, flag_, explain(e));
    }
  }

  bool constant() const { return constant_; }

  double operator()(const Point<D>& p) {
    // A thread starts at its own slot and so meets another there only by chance.
    static std::atomic<unsigned> threads{0};
    thread_local const unsigned first = threads.fetch_add(1, std::memory_order_relaxed);
    for (unsigned i = first;; ++i) {
      Slot<D>& slot = slots_[i % slots_.size()];
      // acquire/release: the last owner's parser and variables are ours to use
      if (slot.busy.test_and_set(std::memory_order_acquire)) {
        if (i % slots_.size() == first % slots_.size() && i != first) std::this_thread::yield();
        continue;
      }
      struct Release {
        std::atomic_flag& busy;
        ~Release() { busy.clear(std::memory_order_release); }
      } release{slot.busy};
      try {
        if (!slot.parser) slot.compile(text_);
        slot.at = p;
        return slot.parser->Eval();
      } catch (const mu::Parser::exception_type& e) {
        refuse(text_, flag_, explain(e));
      }
    }
  }

 private:
  static std::string explain(const mu::Parser::exception_type& e) {
    return e.GetMsg() + (D == 2 ? " (variables: x, y)" : " (variables: x, y, z)");
  }

  std::string text_, flag_;
  std::array<Slot<D>, 64> slots_;
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
