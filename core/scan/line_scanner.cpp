// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>

#include "scan/line_scanner.hpp"

namespace pgdr::detail {
namespace {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f' || c == ','; }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string described(Subject s) {
  std::string text(s.what);
  if (s.id >= 0) text.append(" ").append(std::to_string(s.id));
  return text;
}

std::vector<std::int64_t> ids_of(Subject s) { return s.id < 0 ? std::vector<std::int64_t>{} : std::vector<std::int64_t>{s.id}; }

/// The value of a decimal number that from_chars found out of range: its order of magnitude decides.
double beyond_range(std::string_view token) {
  const bool negative = token.front() == '-';
  const std::size_t e = std::min(token.find_first_of("eE"), token.size());
  long long exponent = 0;
  if (e < token.size()) {
    std::string_view digits = token.substr(e + 1);
    if (digits.front() == '+') digits.remove_prefix(1);
    const auto r = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    if (r.ec != std::errc{}) exponent = digits.front() == '-' ? -1'000'000'000'000 : 1'000'000'000'000;
  }
  const std::string_view mantissa = token.substr(0, e);
  const std::size_t dot = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t lead = mantissa.find_first_of("123456789");
  if (lead == std::string_view::npos) return negative ? -0.0 : 0.0;
  exponent += static_cast<long long>(dot) - static_cast<long long>(lead);
  const double magnitude = exponent > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  return negative ? -magnitude : magnitude;
}

/// "1.#QNAN" and its kin: what old Microsoft libraries print for NaN and infinity.
bool is_microsoft_infinity(std::string_view token) { return token.find(".#") != std::string_view::npos; }

}  // namespace

std::string quoted(std::string_view token) {
  constexpr std::size_t longest = 40;
  std::string text = "'";
  for (const char c : token.substr(0, longest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (token.size() > longest ? "...'" : "'");
}

std::optional<double> parse_double(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  double value = 0;
  const char* end = token.data() + token.size();
  const auto r = std::from_chars(token.data(), end, value);
  if (r.ptr != end || r.ec == std::errc::invalid_argument) return std::nullopt;
  if (r.ec == std::errc::result_out_of_range) return beyond_range(token);
  return value;
}

std::optional<std::int64_t> parse_integer(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  std::int64_t value = 0;
  const char* end = token.data() + token.size();
  const auto r = std::from_chars(token.data(), end, value);
  if (r.ptr != end || r.ec != std::errc{}) return std::nullopt;
  return value;
}

LineScanner::LineScanner(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {
  if (text_.starts_with("\xEF\xBB\xBF")) pos_ = 3;
}

void LineScanner::skip_blanks() {
  while (pos_ < text_.size() && is_blank(text_[pos_])) ++pos_;
  if (pos_ < text_.size() && text_[pos_] == '#') {
    while (pos_ < text_.size() && text_[pos_] != '\n') ++pos_;
  }
}

bool LineScanner::more_on_line() {
  skip_blanks();
  return pos_ < text_.size() && text_[pos_] != '\n';
}

bool LineScanner::advance() {
  while (!more_on_line()) {
    if (pos_ == text_.size()) return false;
    ++pos_;
    ++line_;
  }
  return true;
}

void LineScanner::require(Subject s) {
  if (!advance()) fail(Errc::truncated, "the file ends where " + described(s) + " is expected", ids_of(s));
}

void LineScanner::next_line(Subject s) {
  end_line(s);
  require(s);
}

void LineScanner::end_line(Subject s) {
  if (more_on_line()) fail_at(Errc::syntax, s, take(), " is left over on the line before ");
}

void LineScanner::skip_line() {
  while (pos_ < text_.size() && text_[pos_] != '\n') ++pos_;
}

std::string_view LineScanner::rest_of_line() {
  const std::size_t begin = pos_;
  skip_line();
  return text_.substr(begin, pos_ - begin);
}

void LineScanner::enter_bytes(Subject s) {
  end_line(s);
  bytes(s, 1);
  ++line_;
}

std::string_view LineScanner::bytes(Subject s, std::size_t n) {
  if (n > remaining()) fail(Errc::truncated, "the file ends within " + described(s), ids_of(s));
  const std::string_view taken = text_.substr(pos_, n);
  pos_ += n;
  return taken;
}

bool LineScanner::accept(std::string_view literal) {
  if (!text_.substr(pos_).starts_with(literal)) return false;
  pos_ += literal.size();
  return true;
}

std::string_view LineScanner::take() {
  const std::size_t begin = pos_;
  while (pos_ < text_.size() && !is_blank(text_[pos_]) && text_[pos_] != '\n') {
    const bool comment = text_[pos_] == '#' &&
                         (pos_ == begin || text_[pos_ - 1] != '.' || pos_ + 1 == text_.size() || text_[pos_ + 1] < 'A');
    if (comment) break;
    ++pos_;
  }
  return text_.substr(begin, pos_ - begin);
}

std::string_view LineScanner::word(Subject s) {
  if (more_on_line()) return take();
  if (pos_ == text_.size()) fail(Errc::truncated, "the file ends within " + described(s), ids_of(s));
  fail(Errc::syntax, "the line ends within " + described(s), ids_of(s));
}

std::int64_t LineScanner::integer(Subject s) {
  const std::string_view token = word(s);
  const auto value = parse_integer(token);
  if (!value) fail_at(Errc::syntax, s, token, " is not an integer, in ");
  return *value;
}

int LineScanner::marker(Subject s) {
  const std::string_view token = word(s);
  const auto value = parse_integer(token);
  if (!value || *value != static_cast<int>(*value)) fail_at(Errc::syntax, s, token, " is not a marker, in ");
  return static_cast<int>(*value);
}

double LineScanner::number(Subject s, bool finite) {
  const std::string_view token = word(s);
  const auto value = parse_double(token);
  if (!value && !is_microsoft_infinity(token)) fail_at(Errc::syntax, s, token, " is not a number, in ");
  if (finite && (!value || !std::isfinite(*value))) fail_at(Errc::not_finite, s, token, " is not finite, in ");
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

std::size_t LineScanner::count(Subject s, std::size_t bytes_each) {
  const std::string_view token = word(s);
  const bool digits = std::all_of(token.begin(), token.end(), is_digit);
  if (!digits) fail_at(Errc::syntax, s, token, " is not a count, in ");
  const auto value = parse_integer(token);
  check_count(s, value ? static_cast<std::uint64_t>(*value) : std::numeric_limits<std::uint64_t>::max(), bytes_each);
  return static_cast<std::size_t>(*value);
}

void LineScanner::check_count(Subject s, std::uint64_t n, std::size_t bytes_each) const {
  // The last thing of all needs no blank behind it, hence the one byte more.
  constexpr std::uint64_t most_ids = 0xfffffffe;
  if (n <= (remaining() + 1) / bytes_each && n <= most_ids) return;
  // A count that is wrong and a file that was cut look the same; few things missing tell of a cut.
  constexpr std::uint64_t few = 64;
  const std::string left = std::to_string(remaining()) + " bytes";
  if (n <= few)
    fail(Errc::truncated, "the file ends within " + described(s) + ": " + left + " are left for " + std::to_string(n), ids_of(s));
  const std::string promised = n == std::numeric_limits<std::uint64_t>::max() ? "that many" : std::to_string(n);
  fail(Errc::count_too_large, "the file cannot hold " + promised + " entries of " + described(s) + " in " + left, ids_of(s));
}

std::uint32_t LineScanner::reference(Subject s, std::uint32_t first, std::size_t n) {
  const std::int64_t id = integer(s);
  // Unsigned, so that no value of the file can overflow.
  const std::uint64_t offset = static_cast<std::uint64_t>(id) - first;
  if (offset < n) return static_cast<std::uint32_t>(offset);
  std::vector<std::int64_t> ids = ids_of(s);
  ids.push_back(id);
  const std::string range = std::to_string(first) + " to " + std::to_string(first + n - 1);
  const std::string known = n == 0 ? "there are no points" : "points are numbered " + range;
  fail(Errc::index_out_of_range, described(s) + " refers to point " + std::to_string(id) + ", but " + known, ids);
}

void LineScanner::fail_at(Errc code, Subject s, std::string_view token, std::string_view why) const {
  fail(code, quoted(token) + std::string(why) + described(s), ids_of(s));
}

void LineScanner::fail(Errc code, const std::string& message, const std::vector<std::int64_t>& ids) const {
  // Counted anew, since `bytes` counts none.
  const auto ends = std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(pos_), '\n');
  throw InputError(Diagnostic{code, message, file_, static_cast<std::uint64_t>(ends) + 1, ids, {}});
}

}  // namespace pgdr::detail
