// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What the words behind a flag have to be. Each says what is wrong with one that is not.
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace pgdr::tool {

/// A number in the given range; `nan` is never one.
inline CLI::Validator number(const std::string& range, bool (*accept)(double)) {
  return {[range, accept](std::string& text) {
            double value = 0;
            const bool ok = CLI::detail::lexical_cast(text, value) && accept(value);
            return ok ? std::string() : "must be a number " + range + ", not \"" + text + '"';
          },
          "", "number " + range};
}

/// A whole number in decimal digits, which CLI11 alone would let wrap round zero.
inline CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  return {[least, most](std::string& text) {
            std::uint64_t value = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
            const bool ok = error == std::errc() && end == text.data() + text.size() && value >= least && value <= most;
            return ok ? std::string()
                      : "must be a whole number from " + std::to_string(least) + " to " + std::to_string(most) + ", not \"" +
                            text + '"';
          },
          "", "whole number"};
}

/// Finite numbers between commas; none if the text is anything else.
inline std::vector<double> numbers(const std::string& text) {
  std::vector<double> list;
  for (const std::string& word : CLI::detail::split(text, ',')) {
    double value = 0;
    if (!CLI::detail::lexical_cast(word, value) || !std::isfinite(value)) return {};
    list.push_back(value);
  }
  return list;
}

inline bool positive(double v) { return v > 0; }
inline bool not_negative(double v) { return v >= 0 && std::isfinite(v); }

inline CLI::Validator shaped(bool (*accept)(const std::string&), const std::string& what) {
  return {
      [accept, what](std::string& text) { return accept(text) ? std::string() : "must be " + what + ", not \"" + text + '"'; },
      "", what};
}

/// A word of the map from words to values.
template <class Value>
CLI::Validator one_of(const std::map<std::string, Value>& words, std::string what) {
  return {[&words, what](std::string& text) {
            if (words.count(text)) return std::string();
            std::string list;
            for (const auto& [word, value] : words) list += (list.empty() ? "" : ", ") + word;
            return "the " + what + " of this version: " + list + ", not \"" + text + '"';
          },
          "", what};
}

}  // namespace pgdr::tool
