// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "numbers/exact_sum.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "numbers/fixed_point.hpp"

namespace pgdr::detail {
namespace {

constexpr int digit_bits = 32;
constexpr std::int64_t digit_mask = 0xffffffff;
constexpr int product_digits = 6;               // 3 x 53 bits, anywhere in a digit
constexpr std::uint32_t most_added = 1u << 30;  // before digits have to be carried

/// A double as mantissa * 2^(exponent - 1074).
struct Parts {
  std::uint64_t mantissa;
  int exponent;
  bool negative;

  explicit Parts(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const int biased = static_cast<int>(bits >> 52 & 0x7ff);
    mantissa = (bits & ((std::uint64_t{1} << 52) - 1)) | std::uint64_t{biased != 0} << 52;
    exponent = std::max(biased, 1) - 1;
    negative = bits >> 63 != 0;
  }
};

/// Carries all digits but the last, which bears the sign, into [0, 2^32).
void carry_digits(std::vector<std::int64_t>& digits) {
  std::int64_t carried = 0;
  for (std::int64_t& digit : digits) {
    digit += carried;
    carried = digit >> digit_bits;
    digit &= digit_mask;
  }
  while (carried != 0 && carried != -1) {
    digits.push_back(carried & digit_mask);
    carried >>= digit_bits;
  }
  digits.push_back(carried);
}

/// The magnitude of a sum, its digits from the lowest, and whether it was negative.
bool take_sign(std::vector<std::int64_t>& digits) {
  carry_digits(digits);
  const bool negative = digits.back() < 0;
  if (negative) {
    for (std::int64_t& digit : digits) digit = -digit;
    carry_digits(digits);
  }
  return negative;
}

}  // namespace

void ExactSum::add_product(double a, double b, double c) {
  if (a == 0 || b == 0 || c == 0) return;
  const Parts x(a), y(b), z(c);
  // Three words of 64 bits, shifted to where the product begins in its lowest digit.
  const Word2 two = static_cast<Word2>(x.mantissa) * y.mantissa;
  const Word2 low = static_cast<Word2>(static_cast<std::uint64_t>(two)) * z.mantissa;
  const Word2 high = static_cast<Word2>(static_cast<std::uint64_t>(two >> 64)) * z.mantissa + (low >> 64);
  const int exponent = x.exponent + y.exponent + z.exponent, shift = exponent % digit_bits, place = exponent / digit_bits;
  const Word2 shifted_high = high << shift | static_cast<Word2>(static_cast<std::uint64_t>(low)) >> (64 - shift);
  const std::uint64_t shifted_low = static_cast<std::uint64_t>(low) << shift;
  if (digits_.empty()) first_ = place;
  if (place < first_) {
    digits_.insert(digits_.begin(), static_cast<std::size_t>(first_ - place), 0);
    first_ = place;
  }
  const auto at = static_cast<std::size_t>(place - first_);
  if (digits_.size() < at + product_digits) digits_.resize(at + product_digits);
  const std::array<std::uint64_t, 3> words{shifted_low, static_cast<std::uint64_t>(shifted_high),
                                           static_cast<std::uint64_t>(shifted_high >> 64)};
  const std::int64_t sign = (x.negative != y.negative) != z.negative ? -1 : 1;
  for (std::size_t i = 0; i < words.size(); ++i) {
    digits_[at + 2 * i] += sign * static_cast<std::int64_t>(words[i] & digit_mask);
    digits_[at + 2 * i + 1] += sign * static_cast<std::int64_t>(words[i] >> digit_bits);
  }
  if (++added_ == most_added) carry();
}

void ExactSum::add(const ExactSum& other) {
  if (other.digits_.empty()) return;
  if (digits_.empty()) first_ = other.first_;
  if (other.first_ < first_) {
    digits_.insert(digits_.begin(), static_cast<std::size_t>(first_ - other.first_), 0);
    first_ = other.first_;
  }
  const auto at = static_cast<std::size_t>(other.first_ - first_);
  if (digits_.size() < at + other.digits_.size()) digits_.resize(at + other.digits_.size());
  for (std::size_t i = 0; i < other.digits_.size(); ++i) digits_[at + i] += other.digits_[i];
  added_ += other.added_ + 1;  // of a digit that was carried, too; below 2^31, as either was below `most_added`
  if (added_ >= most_added) carry();
}

void ExactSum::carry() {
  carry_digits(digits_);
  added_ = 0;
}

void ExactSum::add_determinant(const Point2& a, const Point2& b) {
  add_product(a[0], b[1]);
  add_product(-a[1], b[0]);
}

void ExactSum::add_determinant(const Point3& a, const Point3& b, const Point3& c) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    add_product(a[i], b[j], c[k]);
    add_product(-a[i], b[k], c[j]);
  }
}

std::vector<std::int64_t> ExactSum::to_words() const {
  std::vector<std::int64_t> words = digits_;
  if (!words.empty()) carry_digits(words);
  words.push_back(first_);
  return words;
}

ExactSum ExactSum::of_words(std::span<const std::int64_t> words) {
  ExactSum sum;
  sum.digits_.assign(words.begin(), words.end() - 1);
  sum.first_ = static_cast<int>(words.back());
  return sum;
}

double ExactSum::divided_by(unsigned divisor) const {
  std::vector<std::int64_t> digits = digits_;
  if (digits.empty()) return 0;
  const bool negative = take_sign(digits);
  std::uint64_t rest = 0;
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit) {
    const std::uint64_t dividend = rest << digit_bits | static_cast<std::uint64_t>(*digit);
    *digit = static_cast<std::int64_t>(dividend / divisor);
    rest = dividend % divisor;
  }
  while (!digits.empty() && digits.back() == 0) digits.pop_back();
  if (digits.empty()) return 0;
  // The upper 64 bits; the last stands for all below, of which a nearest double needs no more.
  const std::size_t top = digits.size() - 1;
  const auto word = [&](std::size_t below) { return below > top ? Word2{0} : static_cast<Word2>(digits[top - below]); };
  Word2 upper = word(0) << 96 | word(1) << 64 | word(2) << 32 | word(3);
  const int zeros = std::countl_zero(static_cast<std::uint64_t>(upper >> 64));
  upper <<= zeros;
  bool inexact = rest != 0 || static_cast<std::uint64_t>(upper) != 0;
  for (std::size_t i = 0; i + 4 <= top; ++i) inexact = inexact || digits[i] != 0;
  const std::uint64_t leading = static_cast<std::uint64_t>(upper >> 64) | (inexact ? 1 : 0);
  const int exponent = digit_bits * (first_ + static_cast<int>(top) - 1) - zeros - 3 * 1074;
  const double value = std::ldexp(static_cast<double>(leading), exponent);
  return negative ? -value : value;
}

}  // namespace pgdr::detail
