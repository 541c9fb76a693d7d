// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "rule/size_guesses.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "numbers/vectors.hpp"

namespace pgdr {
namespace {

using Bits = std::array<std::uint64_t, 3>;

/// By these points are told from each other, as a function may tell 0 from -0.
Bits bits_of(const Point3& x) { return std::bit_cast<Bits>(x.x); }

std::uint64_t hash_of(const Point3& x, int region) {
  auto h = static_cast<std::uint64_t>(region);
  for (const std::uint64_t bits : bits_of(x)) {
    h = (h ^ bits) * 0x9e3779b97f4a7c15u;
    h ^= h >> 29;
  }
  return h;
}

}  // namespace

void SizeGuesses::forget() {
  known_.clear();
  asked_ = 0;
  std::fill(slots_.begin(), slots_.end(), 0);
}

/// Makes the table twice as large.
void SizeGuesses::grow() {
  slots_.assign(std::max<std::size_t>(2 * slots_.size(), 1024), 0);
  for (std::uint32_t n = 0; n < known_.size(); ++n) {
    std::size_t i = hash_of(known_[n].at, known_[n].region) & (slots_.size() - 1);
    while (slots_[i] != 0) i = (i + 1) & (slots_.size() - 1);
    slots_[i] = n + 1;
  }
}

/// The number of the size of a cell, which is a new one if it is neither known nor guessed yet.
std::uint32_t SizeGuesses::find(const Simplex<3>& s, int region) {
  if (2 * (known_.size() + 1) > slots_.size()) grow();
  const Point3 at = centroid<3>(s);
  std::size_t i = hash_of(at, region) & (slots_.size() - 1);
  for (; slots_[i] != 0; i = (i + 1) & (slots_.size() - 1))
    if (const Known& k = known_[slots_[i] - 1]; bits_of(k.at) == bits_of(at) && k.region == region) return slots_[i] - 1;
  known_.push_back({at, region, 0});
  return (slots_[i] = static_cast<std::uint32_t>(known_.size())) - 1;
}

void SizeGuesses::begin(const Simplex<3>& s, int region) {
  uses_.clear();
  guessed_ = 0;
  wrong_ = false;
  if (known_.size() > most_remembered) forget();
  about_ = find(s, region);
  guess_ = about_ < asked_ ? known_[about_].size : 0;  // there is none yet
}

void SizeGuesses::add(const Simplex<3>& s, int region) {
  using detail::difference;
  const auto normal = detail::cross(difference<3>(s[1], s[0]), difference<3>(s[2], s[0]));
  if (detail::dot(normal, difference<3>(s[3], s[0])) > 0) find(s, region);
}

double SizeGuesses::answer(const Simplex<3>& s, int region, Answer answer, const Numbers& numbers) {
  const std::uint32_t n = find(s, region);
  if (n < asked_) return answer(s, numbers, known_[n].size);
  const double given = guess_ > 0 ? answer(s, numbers, guess_) : 0;
  if (guess_ > 0 && (is_short_ || given == answer(s, numbers, CellBounds<3>::infinity))) {
    ++guessed_;
    uses_.push_back({n, s, answer, numbers, given});
    return given;
  }
  if (along_) along_(*this);
  ask();
  return answer(s, numbers, known_[n].size);
}

/// Asks for all that is not known, and looks whether the guesses were right.
void SizeGuesses::ask() {
  points_.clear();
  regions_.clear();
  for (std::size_t n = asked_; n < known_.size(); ++n) {
    points_.push_back(known_[n].at);
    regions_.push_back(known_[n].region);
  }
  sizes_.resize(points_.size());
  bounds_->sizes_at(points_, regions_, sizes_);
  for (const double size : sizes_) known_[asked_++].size = size;
  for (const Use& u : uses_) wrong_ = wrong_ || u.answer(u.s, u.numbers, known_[u.known].size) != u.given;
  uses_.clear();
  if (about_ < asked_) guess_ = known_[about_].size;
}

bool SizeGuesses::settle() {
  if (!uses_.empty()) ask();
  return !std::exchange(wrong_, false);
}

}  // namespace pgdr
