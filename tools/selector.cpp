// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "selector.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

#include "pgdr/selectors.hpp"

namespace pgdr::tool {
namespace {

enum class Kind { circumcenter, off_center, optimized, sliver_avoiding, random };

struct Named {
  const char* name;
  Kind kind;
};
constexpr Named known[] = {{"circumcenter", Kind::circumcenter},
                           {"off-center", Kind::off_center},
                           {"optimized", Kind::optimized},
                           {"sliver-avoiding", Kind::sliver_avoiding},
                           {"random", Kind::random}};
constexpr double most_samples = 1000000, most_seed = 4294967295;

struct Choice {
  Kind kind = Kind::circumcenter;
  std::optional<double> parameter;
};

/// The choice, or what is wrong with it.
std::string parse(const std::string& text, Choice& choice) {
  const auto colon = text.find(':');
  const Named* named = nullptr;
  std::string names;
  for (const Named& n : known) {
    if (text.substr(0, colon) == n.name) named = &n;
    names += (names.empty() ? "" : ", ") + std::string(n.name);
  }
  if (!named) return "the selectors of this version: " + names + ", not \"" + text + '"';
  choice.kind = named->kind;
  if (colon == std::string::npos) return {};
  if (choice.kind == Kind::circumcenter) return "circumcenter has no parameter, not \"" + text + '"';
  double value = 0;
  const char *first = text.data() + colon + 1, *last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, value);
  const bool is_number = error == std::errc() && end == last && std::isfinite(value);
  choice.parameter = value;
  if (choice.kind == Kind::off_center)
    return is_number && value > 0 ? "" : "the factor of off-center must be a number > 0, not \"" + text + '"';
  if (choice.kind == Kind::random)
    return is_number && value >= 0 && value <= most_seed && value == std::floor(value)
               ? ""
               : "the seed of random must be a whole number from 0 to 4294967295, not \"" + text + '"';
  const bool is_count = is_number && value >= 1 && value <= most_samples && value == std::floor(value);
  return is_count
             ? ""
             : "the parameter of " + std::string(named->name) + " must be a whole number from 1 to 1000000, not \"" + text + '"';
}

Choice parsed(const std::string& text) {
  Choice choice;
  parse(text, choice);
  return choice;
}

}  // namespace

std::string selector_error(const std::string& text) {
  Choice choice;
  return parse(text, choice);
}

template <int D>
PointSelector<D> make_selector(const std::string& text) {
  const auto [kind, p] = parsed(text);
  switch (kind) {
    case Kind::off_center: return p ? off_center<D>(*p) : off_center<D>();
    case Kind::optimized: return p ? optimized<D>(static_cast<int>(*p)) : optimized<D>();
    case Kind::sliver_avoiding: return p ? sliver_avoiding<D>(static_cast<int>(*p)) : sliver_avoiding<D>();
    case Kind::random: return randomized<D>(p ? static_cast<std::uint32_t>(*p) : 0);
    case Kind::circumcenter: break;
  }
  return {};
}

DiskType usual_disk(const std::string& text) {
  return parsed(text).kind == Kind::circumcenter ? DiskType::type2 : DiskType::type1;
}

template PointSelector<2> make_selector<2>(const std::string&);
template PointSelector<3> make_selector<3>(const std::string&);

}  // namespace pgdr::tool
