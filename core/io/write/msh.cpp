// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes gmsh's .msh 4.1, binary. Cells, subfacets, subsegments and points with a marker are elements; those of one
// dimension and label form an entity, and this a physical group. Positive integers are the numbers of their groups; any
// other label gets a free number, and the group, if the label has no name of its own, the name "pgdr marker <m>" or
// "pgdr region <a>", since gmsh knows positive numbers alone, and its readers want all elements in groups if any is. Of a label
// that is none of these numbers and has a name, a comment says which it is. Nodes belong to the entity of lowest
// dimension that they lie on. Tags of nodes are their places, from 1; those of elements too, cells first.
#include <algorithm>
#include <bit>
#include <compare>
#include <limits>
#include <string>
#include <utility>

#include "io/formats.hpp"
#include "io/write/valid_names.hpp"
#include "io/write/wall_sides.hpp"
#include "output/mid_sides.hpp"

namespace pgdr::detail {
namespace {

constexpr std::uint32_t none = 0xffffffff;

/// Elements of one dimension: the distinct labels in increasing order, each an entity whose tag is its place, from 1.
class Groups {
 public:
  Groups(int dimension, std::vector<double> labels)
      : dimension_(dimension), labels_(distinct_labels(std::move(labels))), physical_(positive_numbers(labels_)) {}

  int dimension() const { return dimension_; }
  std::size_t count() const { return labels_.size(); }
  double label(std::size_t group) const { return labels_[group]; }
  int physical(std::size_t group) const { return physical_[group]; }
  bool is_own_number(std::size_t group) const { return is_positive_number(labels_[group]); }
  std::size_t group_of(double label) const {
    return static_cast<std::size_t>(std::lower_bound(labels_.begin(), labels_.end(), label, before) - labels_.begin());
  }

 private:
  static bool before(double a, double b) { return std::strong_order(a, b) < 0; }

  int dimension_;
  std::vector<double> labels_;
  std::vector<int> physical_;
};

/// Things in the order of their groups: those of group g are items[begin[g]] to items[begin[g + 1]].
struct Buckets {
  std::vector<std::size_t> begin;
  std::vector<std::uint32_t> items;
};

/// @param group_of of each of the n things, or `none`
template <class GroupOf>
Buckets bucketed(std::size_t n, std::size_t groups, const GroupOf& group_of) {
  Buckets b;
  b.begin.resize(groups + 1);
  for (std::size_t i = 0; i < n; ++i) {
    if (group_of(i) != none) ++b.begin[group_of(i) + 1];
  }
  for (std::size_t g = 0; g < groups; ++g) b.begin[g + 1] += b.begin[g];
  b.items.resize(b.begin.back());
  std::vector<std::size_t> next(b.begin.begin(), b.begin.end() - 1);
  for (std::size_t i = 0; i < n; ++i) {
    if (group_of(i) != none) b.items[next[group_of(i)]++] = static_cast<std::uint32_t>(i);
  }
  return b;
}

struct Box {
  std::array<double, 3> low, high;
  bool empty = true;
  void add(const std::array<double, 3>& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = empty ? p[k] : std::min(low[k], p[k]);
      high[k] = empty ? p[k] : std::max(high[k], p[k]);
    }
    empty = false;
  }
};

/// The elements of one dimension, as the sections need them.
struct Layer {
  Groups groups;
  std::int32_t type;                 ///< gmsh's number
  std::size_t nodes;                 ///< of an element: corners, and of second order those in the middles of edges
  std::vector<std::uint32_t> group;  ///< of each element; `none`: it is not written
  std::uint64_t first_tag = 1;       ///< element i has tag first_tag + i
  Buckets buckets{};
};

template <int D>
class MshWriter {
 public:
  MshWriter(const OutputMesh<D>& mesh, const std::vector<PeriodicPairs>& periodic, const MidSides<D>* middles, FileOutput& out)
      : mesh_(mesh), periodic_(periodic), middles_(middles), names_(valid_names(mesh.names, msh_names)), out_(out) {
    layers_.push_back(point_layer());
    layers_.push_back(constraint_layer(mesh.subsegments, 1, 1));
    if constexpr (D == 3) layers_.push_back(constraint_layer(mesh.subfacets, 2, 2));
    layers_.push_back(cell_layer());
    if (middles_)
      for (std::size_t d = 1; d < layers_.size(); ++d) {
        layers_[d].type = second_order[d];
        layers_[d].nodes = nodes_of_second_order(layers_[d].nodes);
      }
    std::uint64_t tag = 1;
    for (auto layer = layers_.rbegin(); layer != layers_.rend(); ++layer) {
      layer->first_tag = tag;
      tag += layer->group.size();
      layer->buckets = bucketed(layer->group.size(), layer->groups.count(), [&](std::size_t i) { return layer->group[i]; });
    }
    elements_end_ = tag;
  }

  void write() {
    out_.put("$MeshFormat\n4.1 1 8\n");
    out_.put_binary(std::int32_t{1});
    out_.put("\n$EndMeshFormat\n$Comments\npgdr dimension ");
    out_.put_number(D);
    out_.put(" input_points ");
    out_.put_number(mesh_.input_points);
    put_labels_of_names();
    out_.put("\n$EndComments\n");
    put_names();
    put_entities();
    put_nodes();
    put_elements();
    if (!periodic_.empty()) put_periodic();
  }

 private:
  /// Of the input points, if it is known which these are: the others' markers are those of the curves and surfaces.
  Layer point_layer() const {
    const std::size_t known = mesh_.input_points == 0 ? mesh_.point_markers.size() : mesh_.input_points;
    const auto marker = [&](std::size_t i) { return i < known ? mesh_.point_markers[i] : 0; };
    std::vector<double> labels;
    for (std::size_t i = 0; i < mesh_.point_markers.size(); ++i)
      if (marker(i) != 0) labels.push_back(marker(i));
    Layer layer{Groups(0, std::move(labels)), 15, 1, {}};
    for (std::size_t i = 0; i < mesh_.point_markers.size(); ++i)
      layer.group.push_back(marker(i) == 0 ? none : static_cast<std::uint32_t>(layer.groups.group_of(marker(i))));
    return layer;
  }
  template <class Constraints>
  static Layer constraint_layer(const Constraints& constraints, int dimension, std::int32_t type) {
    std::vector<double> labels;
    for (const auto& c : constraints) labels.push_back(c.marker);
    Layer layer{Groups(dimension, std::move(labels)), type, static_cast<std::size_t>(dimension) + 1, {}};
    for (const auto& c : constraints) layer.group.push_back(static_cast<std::uint32_t>(layer.groups.group_of(c.marker)));
    return layer;
  }
  /// There is an entity of the mesh's dimension even where there are no cells, for nodes to belong to.
  Layer cell_layer() const {
    Layer layer{Groups(D, mesh_.regions.empty() ? std::vector<double>{0} : mesh_.regions), D == 2 ? 2 : 4, D + 1, {}};
    for (std::size_t i = 0; i < mesh_.cells.size(); ++i)
      layer.group.push_back(mesh_.regions.empty() ? 0 : static_cast<std::uint32_t>(layer.groups.group_of(mesh_.regions[i])));
    return layer;
  }

  static constexpr std::int32_t second_order[] = {0, 8, 9, 11};  ///< gmsh's numbers of elements, by dimension

  std::uint32_t node(int dimension, std::size_t element, std::size_t k) const {
    const auto corners = static_cast<std::size_t>(dimension) + 1;
    if (k < corners) return corner(dimension, element, k);
    const auto& [a, b] = gmsh_mid_sides[k - corners];
    return middles_->between(corner(dimension, element, a), corner(dimension, element, b));
  }
  std::uint32_t corner(int dimension, std::size_t element, std::size_t k) const {
    if (dimension == D) return mesh_.cells[element][k];
    if (dimension == 0) return static_cast<std::uint32_t>(element);
    return dimension == 1 ? mesh_.subsegments[element].vertices[k] : mesh_.subfacets[element].vertices[k];
  }
  std::array<double, 3> coordinates(std::uint32_t point) const {
    std::array<double, 3> p{};
    for (int k = 0; k < D; ++k) p[static_cast<std::size_t>(k)] = mesh_.points[point][k];
    return p;
  }
  template <class Number>
  void put(Number n) {
    out_.put_binary(n);
  }
  void put_size(std::size_t n) { out_.put_binary(std::uint64_t{n}); }

  /// What a group's label is called; null: it has no name.
  const std::string* name_of(const Groups& groups, std::size_t g) const {
    const auto find = [](const auto& names, auto label) {
      const auto it = names.find(label);
      return it == names.end() ? nullptr : &it->second;
    };
    return groups.dimension() == D ? find(names_.regions, groups.label(g))
                                   : find(names_.markers, static_cast<int>(groups.label(g)));
  }
  template <class F>
  void each_group(const F& f) const {
    for (const Layer& layer : layers_)
      for (std::size_t g = 0; g < layer.groups.count(); ++g) f(layer.groups, g);
  }

  /// "pgdr label <dimension> <group> <label>"
  void put_labels_of_names() {
    each_group([&](const Groups& groups, std::size_t g) {
      if (groups.is_own_number(g) || name_of(groups, g) == nullptr) return;
      out_.put("\npgdr label ");
      out_.put_number(groups.dimension());
      out_.put(' ');
      out_.put_number(groups.physical(g));
      out_.put(' ');
      out_.put_number(groups.label(g));
    });
  }

  void put_names() {
    std::size_t n = 0;
    const auto has_name = [&](const Groups& groups, std::size_t g) { return name_of(groups, g) || !groups.is_own_number(g); };
    each_group([&](const Groups& groups, std::size_t g) { n += has_name(groups, g) ? 1 : 0; });
    if (n == 0) return;
    out_.put("$PhysicalNames\n");
    out_.put_number(n);
    each_group([&](const Groups& groups, std::size_t g) {
      if (!has_name(groups, g)) return;
      out_.put('\n');
      out_.put_number(groups.dimension());
      out_.put(' ');
      out_.put_number(groups.physical(g));
      out_.put(" \"");
      if (const std::string* name = name_of(groups, g)) {
        out_.put(*name);
      } else {
        out_.put(groups.dimension() == D ? "pgdr region " : "pgdr marker ");
        out_.put_number(groups.label(g));
      }
      out_.put('"');
    });
    out_.put("\n$EndPhysicalNames\n");
  }

  void put_entities() {
    out_.put("$Entities\n");
    for (std::size_t d = 0; d < 4; ++d) put_size(d < layers_.size() ? layers_[d].groups.count() : 0);
    for (const Layer& layer : layers_) {
      for (std::size_t g = 0; g < layer.groups.count(); ++g) put_entity(layer, g);
    }
    out_.put("\n$EndEntities\n");
  }
  void put_entity(const Layer& layer, std::size_t g) {
    Box box{{}, {}};
    for (std::size_t i = layer.buckets.begin[g]; i < layer.buckets.begin[g + 1]; ++i) {
      for (std::size_t k = 0; k < layer.nodes; ++k)
        box.add(coordinates(node(layer.groups.dimension(), layer.buckets.items[i], k)));
    }
    put(static_cast<std::int32_t>(g + 1));
    for (const double x : box.low) put(x);
    if (layer.groups.dimension() > 0) {
      for (const double x : box.high) put(x);
    }
    put_size(1);
    put(std::int32_t{layer.groups.physical(g)});
    if (layer.groups.dimension() > 0) put_size(0);  // bounding entities: discrete ones need none
  }

  /// The group of each point in the layer of lowest dimension that has it, counted through all layers.
  std::vector<std::uint32_t> homes(const std::vector<std::size_t>& first_group) const {
    std::vector<std::uint32_t> home(mesh_.points.size(), static_cast<std::uint32_t>(first_group.back()));
    for (std::size_t d = layers_.size(); d-- > 0;) {
      const Layer& layer = layers_[d];
      for (std::size_t i = layer.buckets.items.size(); i-- > 0;) {
        const std::uint32_t element = layer.buckets.items[i];
        for (std::size_t k = 0; k < layer.nodes; ++k)
          home[node(layer.groups.dimension(), element, k)] = static_cast<std::uint32_t>(first_group[d] + layer.group[element]);
      }
    }
    return home;
  }

  void put_nodes() {
    std::vector<std::size_t> first_group;
    std::size_t groups = 0;
    for (const Layer& layer : layers_) {
      first_group.push_back(groups);
      groups += layer.groups.count();
    }
    const std::vector<std::uint32_t> home = homes(first_group);
    const Buckets buckets = bucketed(home.size(), groups, [&home](std::size_t i) { return home[i]; });
    std::size_t blocks = 0;
    for (std::size_t g = 0; g < groups; ++g) blocks += buckets.begin[g] != buckets.begin[g + 1] ? 1 : 0;

    out_.put("$Nodes\n");
    for (const std::size_t n : {blocks, home.size(), std::min<std::size_t>(1, home.size()), home.size()}) put_size(n);
    for (std::size_t d = 0; d < layers_.size(); ++d) {
      for (std::size_t g = 0; g < layers_[d].groups.count(); ++g) {
        const std::size_t begin = buckets.begin[first_group[d] + g], end = buckets.begin[first_group[d] + g + 1];
        if (begin == end) continue;
        put(std::int32_t{layers_[d].groups.dimension()});
        put(static_cast<std::int32_t>(g + 1));
        put(std::int32_t{0});  // not parametric
        put_size(end - begin);
        out_.put_each(end - begin,
                      [&](TextBuffer& bytes, std::size_t i) { bytes.put_binary(std::uint64_t{buckets.items[begin + i]} + 1); });
        out_.put_each(end - begin, [&](TextBuffer& bytes, std::size_t i) {
          for (const double x : coordinates(buckets.items[begin + i])) bytes.put_binary(x);
        });
      }
    }
    out_.put("\n$EndNodes\n");
  }

  void put_elements() {
    std::size_t blocks = 0, elements = 0;
    for (const Layer& layer : layers_) {
      elements += layer.buckets.items.size();
      for (std::size_t g = 0; g < layer.groups.count(); ++g)
        blocks += layer.buckets.begin[g] != layer.buckets.begin[g + 1] ? 1 : 0;
    }
    out_.put("$Elements\n");
    const auto last = static_cast<std::size_t>(elements_end_ - 1);
    for (const std::size_t n : {blocks, elements, std::min<std::size_t>(1, elements), last}) put_size(n);
    for (const Layer& layer : layers_) {
      for (std::size_t g = 0; g < layer.groups.count(); ++g) put_block(layer, g);
    }
    out_.put("\n$EndElements\n");
  }
  void put_block(const Layer& layer, std::size_t g) {
    const std::size_t begin = layer.buckets.begin[g], end = layer.buckets.begin[g + 1];
    if (begin == end) return;
    put(std::int32_t{layer.groups.dimension()});
    put(static_cast<std::int32_t>(g + 1));
    put(layer.type);
    put_size(end - begin);
    out_.put_each(end - begin, [&](TextBuffer& bytes, std::size_t i) {
      const std::uint32_t element = layer.buckets.items[begin + i];
      bytes.put_binary(layer.first_tag + element);
      for (std::size_t k = 0; k < layer.nodes; ++k)
        bytes.put_binary(std::uint64_t{node(layer.groups.dimension(), element, k)} + 1);
    });
  }

  /// A link a pair of sides, with a motion of 4 x 4 numbers, which takes the master to the other.
  void put_periodic() {
    out_.put("$Periodic\n");
    put_size(periodic_.size());
    for (const PeriodicPairs& p : periodic_) {
      const Groups& groups = layers_[D - 1].groups;
      put(std::int32_t{D - 1});
      for (const int marker : {p.to, p.from}) put(static_cast<std::int32_t>(groups.group_of(marker) + 1));
      put_size(16);
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < 4; ++k) put(affine(p.motion, i, k));
      put_size(p.points.size());
      out_.put_each(p.points.size(), [&](TextBuffer& bytes, std::size_t i) {
        bytes.put_binary(std::uint64_t{p.points[i][1]} + 1);
        bytes.put_binary(std::uint64_t{p.points[i][0]} + 1);
      });
    }
    out_.put("\n$EndPeriodic\n");
  }
  static double affine(const std::vector<double>& motion, std::size_t i, std::size_t k) {
    if (i < D && (k < D || k == 3)) return motion[i * (D + 1) + std::min<std::size_t>(k, D)];
    return i == k ? 1 : 0;
  }

  const OutputMesh<D>& mesh_;
  const std::vector<PeriodicPairs>& periodic_;
  const MidSides<D>* middles_;
  const Names names_;
  FileOutput& out_;
  std::vector<Layer> layers_;  ///< by dimension
  std::uint64_t elements_end_ = 1;
};

}  // namespace

template <int D>
void write_msh(const OutputMesh<D>& mesh, const std::vector<PeriodicPairs>& periodic, const MidSides<D>* middles,
               FileOutput& out) {
  MshWriter<D>(mesh, periodic, middles, out).write();
}

template void write_msh<2>(const OutputMesh<2>&, const std::vector<PeriodicPairs>&, const MidSides<2>*, FileOutput&);
template void write_msh<3>(const OutputMesh<3>&, const std::vector<PeriodicPairs>&, const MidSides<3>*, FileOutput&);

}  // namespace pgdr::detail
