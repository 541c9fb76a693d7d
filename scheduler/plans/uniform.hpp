// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The uniform schedule (dissertation, section 3.2). The tree is full: its leaves, the windows, are of one size, and so are the
// nodes of any level above. A visit of a node claims the node's box, grown by half its side on every face: of a window that is a
// block of 4^D cells of the lattice, the window being the inner 2^D. The nodes of one level whose places have the same parity on
// each axis are a phase. Their claims tile space, so that all visits of a phase run at once; what they find for others, and what
// they set aside, takes effect at its end. A level has 2^D phases, a cycle, which come in turn.
//
// The lattice begins with one window and is halved as long as elements are in plenty: a window is left when many wait in it and
// all are small enough for its quarters (eighths). When all windows are left or empty, all are split. So the coarse stage is the
// same algorithm. Of the windows and the nodes right above them what waits goes first, the coarser level before the finer, then
// what the windows have set aside; then the lattice is halved. At last comes what needs larger claims than these.
//
// Theorem U. Let the mesh be Delaunay without encroached boundary, and let all circumradii be r at most. Then an insertion for an
// element with its circumcentre in a node deletes owned cells only, if half of the node's side is (2 + d) r or more, where d is
// the dimension of the boundary that the point may come to lie on instead: 0 in the interior, up to 1 in 2D and 2 in 3D. Proof:
// the point is within d r of the circumcentre, since diametral and equatorial balls are the smallest through their corners, so of
// radius r at most. A cell that is deleted has the point in its circumball, so that all its vertices are within 2 r of it. By
// default half of the side is 2 r (split_ratio): interior insertions are never set aside, and some at the boundary are. What is
// set aside costs a later visit, never an error: ownership (mesh/visit_area.hpp) makes phases safe, whatever the radii are.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "plans/planner.hpp"

namespace pgdr::detail {

/// Phases have numbers that say when they would come: less is sooner. This is that of none.
inline constexpr std::uint64_t no_phase = ~std::uint64_t{0};

/// Which visits run next.
struct Phase {
  std::uint32_t order = 1;  ///< of their requests: 1, 2 for what was set aside, whole_tree
  int level = 0;            ///< of their nodes
  unsigned parity = 0;      ///< of the places of these: bit i for axis i
};

/// See above.
template <int D>
class Uniform final : public Planner<D> {
 public:
  using Node = typename Orthtree<D>::Node;
  using IsOwn = std::function<bool(Node)>;
  static constexpr unsigned parities = 1u << D;

  /// `is_own`: does this rank visit the node? One process visits all. The state must outlive this.
  explicit Uniform(
      RunState<D>& state, IsOwn is_own = [](Node) { return true; });

  StopCause stop() override { return state_->stop_between_visits(); }
  /// Once nothing waits the lattice is not halved any more.
  std::optional<PlannedVisits<D>> next() override;

  /// Halves the lattice if windows have been left for that.
  bool halve();
  /// Will the lattice be halved once more, after the next time, for a window in which so many elements are to come?
  bool is_halved_with(std::uint64_t to_come) const;
  /// Has any window been left, to be split?
  bool is_any_left() const;
  /// The number of the phase that comes first, of what waits, and was set aside, in windows and the nodes right above them;
  /// no_phase if none has work.
  std::uint64_t first_phase_near_windows() const;
  /// The same, of all that waits.
  std::uint64_t first_phase() const;
  /// The phase of this number.
  Phase phase_of(std::uint64_t number) const;
  /// The same, after which its level is at the next parity.
  Phase take_turn(std::uint64_t number);
  /// The visits of the phase that have work, in Morton order.
  Generation<D> visits_of(const Phase& phase) const;
  /// Says when the visit ends.
  void limit(NodeVisit<D>& visit) const;

  const Orthtree<D>& tree() const { return state_->waiting.tree(); }
  int finest() const { return static_cast<int>(levels_.size()) - 1; }  ///< level of the windows
  const std::vector<Node>& nodes(int level, unsigned parity) const {
    return levels_[static_cast<std::size_t>(level)].nodes[parity];
  }

 private:
  struct Level {
    std::array<std::vector<Node>, parities> nodes;  ///< of each parity, in Morton order
    unsigned turn = 0;                              ///< the parity that comes next
    std::uint64_t turns = 0;                        ///< so many parities had their turn, or were passed over
  };

  void add_level();
  int most_levels() const;
  double small_radius() const;
  std::size_t floor() const;
  bool is_left(Node node) const;
  bool has_work(Node node, std::uint32_t order) const;
  bool has_work(int level, unsigned parity, std::uint32_t order) const;
  std::uint64_t first_in_turn(std::size_t order, int from, int to) const;
  Visit<D> visit_of(Node node, std::uint32_t order) const;

  RunState<D>* state_;
  IsOwn is_own_;
  std::vector<Level> levels_;  ///< from the root's on
  bool is_final_ = false;      ///< the lattice is not halved any more
};

extern template class Uniform<2>;
extern template class Uniform<3>;

}  // namespace pgdr::detail
