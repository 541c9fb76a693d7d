// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Sizes near cells of which they are known: a plane through these, in each region, by least squares. So a change can be looked
// for without a question for each cell that it might make. Where all that is known is one number, it is that number to the last
// bit. Plain containers; one thread at a time.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr {

/// See above.
class LocalSizes {
 public:
  void clear() { regions_.clear(); }                            ///< forgets all
  void add(const Point3& at, int region, double size);          ///< a size that is known
  void fit();                                                   ///< must be called before sizes are asked for, once all are added
  std::optional<double> at(const Point3& x, int region) const;  ///< none: nothing is known in the region

 private:
  struct Known {
    Point3 at;
    double size;
  };
  /// Sizes are mean + gradient (x - centre), within [least, most].
  struct Region {
    int region;
    std::vector<Known> known;
    Point3 centre;
    double mean, least, most;
    std::array<double, 3> gradient;
  };
  static void fit(Region& r);

  std::vector<Region> regions_;
};

}  // namespace pgdr
