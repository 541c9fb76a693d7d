// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Most patches of a surface, and what is given about them, are like hills over one plane. There a triangle is within a distance
// of the other surface if triangles of that surface cover it in the projection, and no heights differ by more.
//
// Covered is an open triangle if one of them meets it, and at each of their edges that meets it another one lies on the other
// side. For what they cover of it is closed in it, since they are; and open: about a point inside of an edge since both sides of
// it are covered, about a corner since all edges there have their other sides, all round. The triangles at an edge are known for
// both surfaces, so that the cover is found by going from neighbour to neighbour, and no part is cut.
//
// A yes is a proof; else nothing is said.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "replace/overlay.hpp"
#include "replace/patch_tests.hpp"
#include "replace/shape.hpp"

namespace pgdr::detail {

/// A given triangle that is near a change, and its box.
struct NearGiven {
  std::uint32_t number;
  Box<3> box;
};

/// For one change. May be asked by one thread at a time, while the surface does not change.
class HeightProof {
 public:
  /// @param given  all whose boxes meet those of the faces that come, grown by e
  /// @param near  the box of the faces that go, grown by e: faces that do not meet it are not looked at
  HeightProof(const ChangingSurface& s, const SurfaceChange& change, double e, std::span<const NearGiven> given,
              const Box<3>& near);

  /// The faces that come, those with the longest sides first: what is too far is so over these, mostly.
  std::vector<std::size_t> longest_first() const;
  /// Is face k of those that come within e of the given triangles of its class? Each has to be asked before shows_given() is.
  bool shows_face(std::size_t k);
  /// Where that face was farther from a given triangle over the plane than e, if it was.
  const std::optional<Point3>& far_point() const { return far_; }
  /// Is the given triangle over one of the faces that come, no farther than e?
  bool is_over_face(std::size_t place) const { return given_[place].faces != 0; }
  /// May a given triangle be within e of face k of those that go? Not if it is farther in the projection.
  bool may_be_near(std::size_t k, std::size_t place);
  /// Is the given triangle of this place in `given` within e of faces of its class, as they are after the change?
  bool shows_given(std::size_t place);

 private:
  static constexpr std::uint32_t not_known = no_index - 1;
  /// More faces than that are left to the other proof: of them, which come; of those that one given triangle leads to.
  static constexpr std::size_t most_faces = 64, most_steps = 32;

  /// A face that comes, or that stays.
  struct Face {
    std::array<std::uint32_t, 3> corners;  ///< in the order of coordinates
    std::uint32_t klass, number;           ///< number: as in the view
    RaisedTriangle raised;
    std::array<std::uint32_t, 3> beyond{not_known, not_known, not_known};  ///< in faces_, at edge i; no_index: none
  };
  /// A given triangle.
  struct Given {
    bool is_raised = false;
    RaisedTriangle raised;
    std::uint64_t faces = 0;      ///< bit k: its inside meets that of face k of those that come, no farther than e
    std::uint8_t closed = 0;      ///< bit j: beyond edge j there is one, on the other side
    std::uint8_t not_closed = 0;  ///< bit j: there is none
  };

  /// Faces over one given triangle, and which of their edges meet the inside of that.
  struct Steps {
    struct Step {
      std::uint32_t face;
      std::uint8_t edges;
    };
    std::array<Step, most_steps> all;
    std::size_t count = 0;

    bool add(std::uint32_t face, std::uint8_t edges) {
      if (count == most_steps) return false;
      all[count++] = {face, edges};
      return true;
    }
    bool has(std::uint32_t face) const {
      return std::any_of(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count),
                         [face](const Step& step) { return step.face == face; });
    }
  };

  void add_face(std::uint32_t number);
  const RaisedTriangle& raised(std::size_t place);
  const GivenSurface::Triangle& triangle(std::size_t place) const { return s_.given.triangles()[near_given_[place].number]; }
  bool is_closed(std::size_t place, std::size_t edge);
  std::uint32_t beyond(std::uint32_t face, std::size_t edge);
  std::uint32_t find_beyond(std::uint32_t face, std::size_t edge);
  bool is_near_beyond(std::uint32_t face, std::size_t edge, std::size_t place) const;
  bool is_other_side(const Face& face, const Face& other, std::size_t edge) const;
  bool add_staying(std::uint32_t face, std::size_t place, Steps& steps);
  bool is_covered(std::size_t place, Steps& steps);
  std::uint32_t place_of(std::uint32_t number);  ///< in faces_, of a face of the view
  void find_rim();
  std::uint8_t& edges_of(std::uint32_t face, std::size_t place) { return edges_[face * given_.size() + place]; }

  const ChangingSurface& s_;
  const SurfaceChange& change_;
  SurfaceView view_;  // after the change
  double e_;
  std::span<const NearGiven> near_given_;
  Box<3> near_;
  std::optional<Projection> plane_;
  std::vector<Face> faces_;           // those that come, then others as they are found
  std::vector<Given> given_;          // beside near_given_
  std::vector<RaisedTriangle> gone_;  // faces that go, once one is asked for
  std::vector<std::uint8_t> edges_;   // of each that comes and each given one, which of its edges meet the inside of that
  std::optional<Point3> far_;
  std::vector<std::uint32_t> rim_;  // faces that stay, at corners of those that come, once they are asked for
  bool has_rim_ = false;
};

}  // namespace pgdr::detail
