// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Sizes of single regions, by label: what a label has, and errors for labels that no region has.
#pragma once

#include <algorithm>
#include <charconv>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pgdr/error.hpp"
#include "pgdr/size_fields.hpp"

namespace pgdr::detail {

/// The smallest of all fields with this label.
template <int D>
SizingField<D> sizes_of_label(const RegionSizes<D>& sizes, double label) {
  std::vector<SizingField<D>> fields;
  for (const RegionSize<D>& s : sizes)
    if (s.label == label) fields.push_back(s.size);
  return smallest<D>(std::move(fields));
}

/// Shortest digits.
inline std::string label_words(double label) {
  char digits[40];
  return {digits, std::to_chars(digits, digits + sizeof digits, label).ptr};
}

/// @param labels  those that there are; 0, what no seed labels, is always one
/// @throws UsageError bad_option that names the label without a region, and labels that have one
template <int D>
void require_labels(const RegionSizes<D>& sizes, std::span<const double> labels) {
  constexpr std::size_t most_named = 20;
  for (const RegionSize<D>& s : sizes) {
    if (s.label == 0 || std::find(labels.begin(), labels.end(), s.label) != labels.end()) continue;
    std::vector<double> known(labels.begin(), labels.end());
    std::sort(known.begin(), known.end());
    known.erase(std::unique(known.begin(), known.end()), known.end());
    std::string words;
    for (std::size_t i = 0; i < known.size() && i < most_named; ++i) words += (i == 0 ? "" : ", ") + label_words(known[i]);
    if (known.size() > most_named) words += ", ...";
    throw UsageError({Errc::bad_option,
                      "a size is given for the region label " + label_words(s.label) + ", which no region has; there " +
                          (known.empty() ? "are none" : "are " + words),
                      {},
                      0,
                      {},
                      {}});
  }
}

/// The labels of a mesh, each at least once.
template <int D>
std::vector<double> labels_of(const OutputMesh<D>& mesh) {
  std::vector<double> labels;
  for (const double label : mesh.regions)
    if (labels.empty() || labels.back() != label) labels.push_back(label);
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  return labels;
}

}  // namespace pgdr::detail
