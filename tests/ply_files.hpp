// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A PLY file with something of everything, in each encoding.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>

namespace pgdr::test {

enum class PlyEncoding { text, little, big };
constexpr PlyEncoding ply_encodings[] = {PlyEncoding::text, PlyEncoding::little, PlyEncoding::big};

inline std::string ply_name(PlyEncoding e) {
  return e == PlyEncoding::text ? "ascii" : e == PlyEncoding::little ? "binary_little_endian" : "binary_big_endian";
}

class PlyText {
 public:
  explicit PlyText(PlyEncoding e) : encoding_(e) {}
  std::string text;

  template <class T>
  void put(T value) {
    if (encoding_ == PlyEncoding::text) {
      std::ostringstream out;
      out << +value << ' ';
      text += out.str();
      return;
    }
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    if ((encoding_ == PlyEncoding::big) == (std::endian::native == std::endian::little)) std::reverse(bytes.begin(), bytes.end());
    text.append(bytes.data(), bytes.size());
  }
  void end() {
    if (encoding_ == PlyEncoding::text) text += '\n';
  }

 private:
  PlyEncoding encoding_;
};

/// A square pyramid: a quadrilateral and four triangles, with colours, lists and an element of another kind.
inline std::string ply_file(PlyEncoding encoding) {
  PlyText out(encoding);
  out.text = "ply\nformat " + ply_name(encoding) + " 1.0\ncomment a pyramid, # with remarks\nobj_info none\n" +
             "element material 2\nproperty list ushort short numbers\nproperty uchar red\n" +
             "element vertex 5\nproperty double z\nproperty uchar red\nproperty float x\nproperty float32 y\n" +
             "property list uchar float32 weights\n" +
             "element face 5\nproperty float quality\nproperty list uint8 int32 vertex_indices\nproperty uint16 flags\n" +
             "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n";
  for (int i = 0; i < 2; ++i) {
    out.put(static_cast<std::uint16_t>(i));
    for (int k = 0; k < i; ++k) out.put(static_cast<std::int16_t>(-7));
    out.put(static_cast<std::uint8_t>(200));
    out.end();
  }
  const double points[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1.25}};
  for (int i = 0; i < 5; ++i) {
    out.put(points[i][2]);
    out.put(static_cast<std::uint8_t>(i));
    out.put(static_cast<float>(points[i][0]));
    out.put(static_cast<float>(points[i][1]));
    out.put(static_cast<std::uint8_t>(i % 3));
    for (int k = 0; k < i % 3; ++k) out.put(0.5f);
    out.end();
  }
  const int faces[5][4] = {{3, 2, 1, 0}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}};
  for (const auto& face : faces) {
    const int corners = face[3] < 0 ? 3 : 4;
    out.put(-0.125f);
    out.put(static_cast<std::uint8_t>(corners));
    for (int k = 0; k < corners; ++k) out.put(std::int32_t{face[k]});
    out.put(static_cast<std::uint16_t>(65535));
    out.end();
  }
  out.put(std::int32_t{0});
  out.put(std::int32_t{2});
  out.end();
  return out.text;
}

}  // namespace pgdr::test
