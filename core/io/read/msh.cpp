// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads gmsh's .msh, versions 2.x and 4.1, as text and binary (either byte order). The label of an element is its first
// physical group, whose name is that of the label; one that is named "pgdr marker <m>" or "pgdr region <a>", or of which a
// comment says so (io/write/msh.cpp), stands for m or a. Nodes and elements are ordered by their tags, which may have gaps.
// Elements of higher order are refused, since their sides are curved. Gmsh reference manual, sections "MSH file format" and "MSH
// file format version 2 (Legacy)".
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "io/formats.hpp"
#include "io/read/msh_elements.hpp"
#include "scan/byte_order.hpp"
#include "scan/clean_name.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr::detail {
namespace {

constexpr std::size_t int_bytes = 4, double_bytes = 8;

class MshReader {
 public:
  MshReader(std::string_view text, const std::string& file, Want want)
      : in_(text, file),
        elements_(in_, want.purpose == Purpose::input),
        only_dimension_(want.purpose == Purpose::dimension),
        with_periods_(want.purpose == Purpose::periods) {
    mesh_.file = file;
  }

  FileMesh read() {
    in_.require({"$MeshFormat"});
    if (in_.word({}) != "$MeshFormat")
      in_.fail(Errc::unknown_format, "the file does not begin with $MeshFormat: it is not gmsh's, or older than version 2");
    read_format();
    expect_end("$MeshFormat");
    while (!decided_ && in_.advance()) {
      const std::string keyword(in_.word({}));
      if (keyword.size() < 2 || keyword.front() != '$' || keyword.starts_with("$End"))
        in_.fail(Errc::syntax, detail::quoted(keyword) + " stands where a section begins");
      read_section(keyword);
      if (!decided_) expect_end(keyword);
    }
    if (decided_) return std::move(mesh_);
    if (!has_nodes_ || !has_elements_)
      in_.fail(Errc::truncated, has_nodes_ ? "the file has no elements" : "the file has no nodes");
    if (mesh_.input_points > mesh_.points.size())
      in_.fail(Errc::index_out_of_range, "a comment promises more input points than there are points");
    elements_.finish(mesh_);
    for (const auto& [group, name] : names_)
      mesh_.group_names[{group.first, elements_.label_of_physical(group.first, group.second)}] = name;
    return std::move(mesh_);
  }

 private:
  void read_format() {
    constexpr Subject format{"the format"};
    in_.require(format);
    const std::string_view version = in_.word(format);
    const bool v2 = version == "2" || version == "2.0" || version == "2.1" || version == "2.2";
    if (!v2 && version != "4.1")
      in_.fail(Errc::unknown_format, "version " + quoted(version) + " of MSH is not read: 2.2 and 4.1 are");
    version_ = v2 ? 2 : 4;
    const std::int64_t type = in_.integer(format), size = in_.integer(format);
    if ((type != 0 && type != 1) || (size != 8 && (v2 || size != 4)))
      in_.fail(Errc::syntax, "the format is neither text nor binary with numbers of a known size");
    size_bytes_ = static_cast<std::size_t>(size);
    binary_ = type == 1;
    if (!binary_) return in_.end_line(format);
    in_.enter_bytes(format);
    const std::string_view one = in_.bytes(format, int_bytes);
    if (load<std::int32_t>(one, 0, std::endian::big) == 1) order_ = std::endian::big;
    if (load<std::int32_t>(one, 0, order_) != 1) in_.fail(Errc::syntax, "the order of bytes cannot be told");
    elements_.keep_lines(false);
  }

  void expect_end(const std::string& keyword) {
    const std::string end = "$End" + keyword.substr(1);
    in_.require({end});
    const std::string_view word = in_.word({end});
    if (word != end) in_.fail(Errc::syntax, quoted(word) + " stands where " + end + " is expected");
    in_.end_line({end});
  }

  void read_section(const std::string& keyword) {
    if (keyword == "$PhysicalNames") {
      read_names();
    } else if (keyword == "$Comments") {
      read_comments();
    } else if (keyword == "$Entities" && version_ == 4) {
      begin_data();
      read_entities();
    } else if (keyword == "$Nodes") {
      if (std::exchange(has_nodes_, true)) in_.fail(Errc::syntax, "the section $Nodes comes twice");
      if (version_ == 4)
        read_nodes_4();
      else
        read_nodes_2();
      if (!decided_) index_nodes();
    } else if (keyword == "$Elements") {
      if (std::exchange(has_elements_, true)) in_.fail(Errc::syntax, "the section $Elements comes twice");
      if (version_ == 4)
        read_elements_4();
      else
        read_elements_2();
    } else if (keyword == "$Periodic" && with_periods_ && version_ == 4 && has_nodes_) {
      begin_data();
      read_periodic();
    } else if (keyword == "$PartitionedEntities" || keyword == "$ParametricNodes") {
      in_.fail(Errc::unknown_format, keyword + " are not read");
    } else {
      skip_to_end(keyword);
    }
  }

  /// What lies before the end of the section, which stands at the begin of a line.
  std::string_view skip_to_end(const std::string& keyword) {
    const std::size_t n = in_.rest().find("\n$End" + keyword.substr(1));
    if (n == std::string_view::npos) in_.fail(Errc::truncated, "the file ends within " + keyword);
    return in_.bytes({keyword}, n);
  }

  // Numbers of either kind of file.

  /// Data begin behind the end of the line, if they are binary.
  void begin_data() {
    if (binary_) in_.enter_bytes({"a section"});
  }
  template <class Number>
  Number take(Subject s) {
    return load<Number>(in_.bytes(s, sizeof(Number)), 0, order_);
  }
  std::int32_t integer(Subject s) {
    if (binary_) return take<std::int32_t>(s);
    in_.require(s);
    return in_.marker(s);
  }
  std::uint64_t size(Subject s) {
    if (binary_) return size_bytes_ == 8 ? take<std::uint64_t>(s) : take<std::uint32_t>(s);
    in_.require(s);
    const std::int64_t n = in_.integer(s);
    if (n < 0) in_.fail(Errc::syntax, std::to_string(n) + " is not a count or tag, in " + std::string(s.what), {n});
    return static_cast<std::uint64_t>(n);
  }
  double number(Subject s) {
    if (!binary_) {
      in_.require(s);
      return in_.number(s);
    }
    const auto x = take<double>(s);
    if (!std::isfinite(x)) in_.fail(Errc::not_finite, "a coordinate of node " + std::to_string(s.id) + " is not finite", {s.id});
    return x;
  }
  /// A count of things of which each takes so many bytes at least.
  std::size_t count(Subject s, std::size_t text_bytes, std::size_t binary_bytes) {
    const std::uint64_t n = size(s);
    in_.check_count(s, n, binary_ ? binary_bytes : text_bytes);
    return static_cast<std::size_t>(n);
  }
  /// The same where it is text in both kinds of files (version 2).
  std::size_t count_2(Subject s, std::size_t text_bytes, std::size_t binary_bytes) {
    in_.require(s);
    const std::size_t n = in_.count(s, binary_ ? 1 : text_bytes);
    if (binary_) in_.check_count(s, n, binary_bytes);
    begin_data();
    return n;
  }

  // Sections that name things.

  void read_names() {
    constexpr Subject names{"the physical names"};
    in_.require(names);
    const std::size_t n = in_.count(names, 6);  // "0 1 a\n"
    for (std::size_t i = 0; i < n; ++i) {
      in_.require(names);
      const auto dimension = static_cast<int>(in_.integer(names));
      const int physical = in_.marker(names);
      std::string_view name = in_.rest_of_line();
      const std::size_t open = name.find('"'), close = name.rfind('"');
      if (open == std::string_view::npos || open == close) in_.fail(Errc::syntax, "a physical name is not in quotes");
      name = name.substr(open + 1, close - open - 1);
      if (std::string clean = clean_name(name);
          !clean.empty() && !name.starts_with("pgdr marker ") && !name.starts_with("pgdr region "))
        names_[{dimension, physical}] = std::move(clean);
      for (const std::string_view ours : {"pgdr marker ", "pgdr region "}) {
        if (!name.starts_with(ours)) continue;
        const auto value = parse_double(name.substr(ours.size()));
        if (!value || !std::isfinite(*value)) in_.fail(Errc::syntax, "the physical name " + quoted(name) + " names no label");
        elements_.name_physical(dimension, physical, *value);
      }
    }
  }

  /// "pgdr dimension <D> input_points <n>", and "pgdr label <dimension> <group> <label>", which only our files have.
  void read_comments() {
    std::string_view text = skip_to_end("$Comments");
    const std::size_t at = text.find("\npgdr ");
    if (at == std::string_view::npos) return;
    text.remove_prefix(at + 1);
    const std::string_view first = text.substr(0, text.find('\n'));
    LineScanner words(first, mesh_.file);
    const auto next = [&words] { return words.more_on_line() ? words.word({}) : std::string_view(); };
    next();
    const bool dimension = next() == "dimension";
    const auto d = parse_integer(next());
    const bool points = next() == "input_points";
    const auto n = parse_integer(next());
    if (!dimension || !points || !d || (*d != 2 && *d != 3) || !n || *n < 0)
      in_.fail(Errc::syntax, "the comment of pgdr does not say what it should");
    mesh_.dimension = static_cast<int>(*d);
    mesh_.dimension_certain = true;
    mesh_.input_points = static_cast<std::size_t>(*n);
    decided_ = only_dimension_;
    for (text.remove_prefix(first.size()); text.starts_with("\npgdr label ");
         text.remove_prefix(std::min(text.find('\n', 1), text.size())))
      read_label(text.substr(1, text.find('\n', 1) - 1));
  }
  void read_label(std::string_view line) {
    LineScanner words(line, mesh_.file);
    const auto next = [&words] { return words.more_on_line() ? words.word({}) : std::string_view(); };
    next();
    next();
    const auto dimension = parse_integer(next()), physical = parse_integer(next());
    const auto label = parse_double(next());
    if (!dimension || *dimension < 0 || *dimension > 3 || !physical || *physical != static_cast<int>(*physical) || !label ||
        !std::isfinite(*label))
      in_.fail(Errc::syntax, "the comment " + quoted(line) + " does not say what a group's label is");
    elements_.name_physical(static_cast<int>(*dimension), static_cast<int>(*physical), *label);
  }

  void read_entities() {
    std::array<std::size_t, 4> n;
    for (std::size_t d = 0; d < 4; ++d) {
      const std::size_t lists = d == 0 ? 1 : 2;  // of groups, of bounding entities
      const std::size_t bytes = int_bytes + lists * (3 * double_bytes + size_bytes_);
      n[d] = count({"the entities"}, d == 0 ? 10 : 18, bytes);  // "1 0 0 0 0\n"
    }
    for (int d = 0; d < 4; ++d) {
      for (std::size_t i = 0; i < n[static_cast<std::size_t>(d)]; ++i) read_entity(d);
    }
  }
  void read_entity(int dimension) {
    constexpr Subject s{"an entity"};
    const std::int32_t tag = integer(s);
    for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) skip_number(s);
    const std::size_t groups = count(s, 2, int_bytes);
    for (std::size_t i = 0; i < groups; ++i) {
      const std::int32_t physical = integer(s);
      // A sign tells of orientation.
      const bool reversed = physical < 0 && physical != std::numeric_limits<std::int32_t>::min();
      if (i == 0) elements_.set_physical(dimension, tag, reversed ? -physical : physical);
    }
    if (dimension == 0) return;
    const std::size_t bounding = count(s, 2, int_bytes);
    for (std::size_t i = 0; i < bounding; ++i) integer(s);
  }
  void skip_number(Subject s) {
    if (binary_) {
      in_.bytes(s, double_bytes);
      return;
    }
    in_.require(s);
    in_.number(s, false);
  }

  // Nodes.

  void read_nodes_2() {
    const std::size_t n = count_2({"the list of nodes"}, 8, int_bytes + 3 * double_bytes);  // "1 0 0 0\n"
    reserve_nodes(n);
    for (std::size_t i = 0; i < n && !decided_; ++i) {
      const std::int32_t tag = integer({"a node"});
      if (tag < 0) in_.fail(Errc::syntax, "a node has the number " + std::to_string(tag), {tag});
      tags_.push_back(static_cast<std::uint64_t>(tag));
      read_coordinates(i, 0);
    }
  }

  void read_nodes_4() {
    constexpr Subject nodes{"the list of nodes"};
    begin_data();
    const std::size_t blocks = count(nodes, 8, 3 * int_bytes + size_bytes_);
    const std::size_t n = count(nodes, 8, size_bytes_ + 3 * double_bytes);
    size(nodes);
    size(nodes);
    reserve_nodes(n);
    for (std::size_t b = 0; b < blocks && !decided_; ++b) {
      const std::int32_t dimension = integer(nodes);
      integer(nodes);
      const std::int32_t parametric = integer(nodes);
      const std::uint64_t in_block = size(nodes);
      if (dimension < 0 || dimension > 3 || parametric < 0 || parametric > 1)
        in_.fail(Errc::syntax, "a block of nodes has no dimension from 0 to 3, or is neither parametric nor not");
      if (in_block > n - tags_.size()) in_.fail(Errc::syntax, "the blocks have more nodes than the section");
      const std::size_t first = tags_.size();
      for (std::uint64_t i = 0; i < in_block; ++i) tags_.push_back(size({"the tags of the nodes"}));
      for (std::size_t i = first; i < tags_.size() && !decided_; ++i) read_coordinates(i, parametric == 1 ? dimension : 0);
    }
    if (!decided_ && tags_.size() != n) in_.fail(Errc::syntax, "the blocks have fewer nodes than the section");
  }

  void reserve_nodes(std::size_t n) {
    tags_.reserve(n);
    mesh_.points.reserve(n);
  }

  void read_coordinates(std::size_t i, int parameters) {
    const Subject s{"node", static_cast<std::int64_t>(tags_[i])};
    if (!binary_) {
      in_.require(s);
      mesh_.point_lines.push_back(static_cast<std::uint32_t>(in_.line()));
    }
    Point3 p;
    for (int k = 0; k < 3; ++k) p[k] = number(s);
    for (int k = 0; k < parameters; ++k) skip_number(s);
    mesh_.points.push_back(p);
    if (p[2] == 0) return;
    if (mesh_.dimension == 2) in_.fail(Errc::syntax, "node " + std::to_string(s.id) + " has a third coordinate, in 2D", {s.id});
    decided_ = only_dimension_;
  }

  /// Orders the points by their tags, and hands the tags on.
  void index_nodes() {
    if (!std::is_sorted(tags_.begin(), tags_.end())) {
      std::vector<std::size_t> order(tags_.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) { return tags_[a] < tags_[b]; });
      tags_ = permuted(tags_, order);
      mesh_.points = permuted(mesh_.points, order);
      if (!mesh_.point_lines.empty()) mesh_.point_lines = permuted(mesh_.point_lines, order);
    }
    if (const auto twice = std::adjacent_find(tags_.begin(), tags_.end()); twice != tags_.end())
      in_.fail(Errc::syntax, "two nodes have the tag " + std::to_string(*twice), {static_cast<std::int64_t>(*twice)});
    mesh_.first_index = tags_.empty() || tags_.front() != 0 ? 1 : 0;
    elements_.set_nodes(std::move(tags_));
  }

  // Elements.

  void read_elements_4() {
    constexpr Subject list{"the list of elements"};
    begin_data();
    const std::size_t blocks = count(list, 8, 3 * int_bytes + size_bytes_);
    const std::uint64_t n = count(list, 4, 2 * size_bytes_);
    size(list);
    size(list);
    std::uint64_t read = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::int32_t dimension = integer(list), entity = integer(list), code = integer(list);
      const std::uint64_t in_block = size(list);
      if (in_block > n - read) in_.fail(Errc::syntax, "the blocks have more elements than the section");
      read += in_block;
      if (in_block == 0) continue;
      const MshType type = elements_.type_of(code);
      if (type.dimension != dimension) in_.fail(Errc::syntax, "a block of elements has not the dimension of its type");
      const double label = elements_.label_of_entity(dimension, entity);
      MshNodes nodes;
      for (std::uint64_t i = 0; i < in_block; ++i) {
        const std::uint64_t tag = size({"an element"});
        const Subject s{"element", static_cast<std::int64_t>(tag)};
        for (std::size_t k = 0; k < type.nodes; ++k) nodes[k] = size(s);
        elements_.add(type, tag, nodes, label);
      }
    }
    if (read != n) in_.fail(Errc::syntax, "the blocks have fewer elements than the section");
  }

  void read_elements_2() {
    const std::size_t n = count_2({"the list of elements"}, 8, 2 * int_bytes);  // "1 15 0 1\n"
    for (std::size_t read = 0; read < n;) {
      if (!binary_) {
        const std::int32_t tag = integer({"an element"}), code = integer({"an element"}), tags = integer({"an element"});
        read_element_2(code, tag, tags);
        ++read;
        continue;
      }
      const std::int32_t code = integer({"a block"}), in_block = integer({"a block"}), tags = integer({"a block"});
      if (in_block <= 0 || static_cast<std::size_t>(in_block) > n - read)
        in_.fail(Errc::syntax, "the blocks have not as many elements as the section");
      for (std::int32_t i = 0; i < in_block; ++i) read_element_2(code, integer({"an element"}), tags);
      read += static_cast<std::size_t>(in_block);
    }
  }
  void read_element_2(std::int32_t code, std::int32_t tag, std::int32_t tags) {
    const Subject s{"element", tag};
    const MshType type = elements_.type_of(code);
    if (tag < 0 || tags < 0) in_.fail(Errc::syntax, "an element has a negative number", {tag, tags});
    std::int32_t physical = 0;
    for (std::int32_t i = 0; i < tags; ++i) {
      const std::int32_t value = integer(s);
      if (i == 0) physical = value;
    }
    MshNodes nodes;
    for (std::size_t k = 0; k < type.nodes; ++k) nodes[k] = static_cast<std::uint64_t>(std::int64_t{integer(s)});
    elements_.add(type, static_cast<std::uint64_t>(tag), nodes, elements_.label_of_physical(type.dimension, physical));
  }

  // Sides that correspond: pairs of entities, of which the second is the master, which the motion takes to the first.

  void read_periodic() {
    constexpr Subject s{"a pair of sides"};
    const std::size_t links = count(s, 6, 3 * int_bytes + 2 * size_bytes_);  // "1 2 1\n"
    for (std::size_t i = 0; i < links; ++i) {
      const std::int32_t dimension = integer(s), tag = integer(s), master = integer(s);
      FileMesh::PeriodicLink link{
          dimension, elements_.label_of_entity(dimension, master), elements_.label_of_entity(dimension, tag), {}, {}};
      const std::size_t numbers = count(s, 2, double_bytes);
      if (numbers != 0 && numbers != 16) in_.fail(Errc::syntax, "a motion of sides has " + std::to_string(numbers) + " numbers");
      for (std::size_t k = 0; k < numbers; ++k) link.affine.push_back(number_of_motion());
      const std::size_t pairs = count(s, 4, 2 * size_bytes_);
      for (std::size_t k = 0; k < pairs; ++k) {
        const std::uint32_t image = node_of_side(), node = node_of_side();
        link.points.push_back({node, image});
      }
      mesh_.periodic_links.push_back(std::move(link));
    }
  }
  double number_of_motion() {
    constexpr Subject s{"a motion of sides"};
    if (!binary_) in_.require(s);
    const double x = binary_ ? take<double>(s) : in_.number(s);
    if (!std::isfinite(x)) in_.fail(Errc::not_finite, "a motion of sides has a number that is not finite");
    return x;
  }
  std::uint32_t node_of_side() {
    const std::uint64_t tag = size({"a pair of nodes"});
    const std::optional<std::uint32_t> node = elements_.find_node(tag);
    if (!node)
      in_.fail(Errc::index_out_of_range, "a pair of sides refers to node " + std::to_string(tag) + ", which does not exist");
    return *node;
  }

  LineScanner in_;
  MshElements elements_;
  FileMesh mesh_;
  bool only_dimension_, with_periods_;
  bool decided_ = false;  ///< the dimension alone was asked for, and is known
  bool has_nodes_ = false, has_elements_ = false;
  int version_ = 4;
  bool binary_ = false;
  std::endian order_ = std::endian::little;
  std::size_t size_bytes_ = 8;
  std::vector<std::uint64_t> tags_;
  std::map<std::pair<int, int>, std::string> names_;  ///< by dimension and physical group
};

}  // namespace

FileMesh read_msh(std::string_view text, const std::filesystem::path& file, Want want) {
  return MshReader(text, file.string(), want).read();
}

}  // namespace pgdr::detail
