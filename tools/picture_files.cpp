// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <memory>
#include <new>
#include <ostream>
#include <string>

#include "picture.hpp"
#ifdef PGDR_CAIRO
#include <cairo.h>
#endif

namespace pgdr::tool {
namespace {

void append(std::string& text, float v) {  // in any locale
  char digits[64];
  const auto end = std::to_chars(digits, digits + sizeof digits, v, std::chars_format::fixed, 2).ptr;
  text.append(digits, end);
}

void append(std::string& text, const Pixel& p) {
  append(text, p[0]);
  text += ',';
  append(text, p[1]);
}

}  // namespace

void write_svg(const Picture& picture, std::ostream& out) {
  const std::string width = std::to_string(picture.width), height = std::to_string(picture.height);
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << width << "\" height=\"" << height << "\" viewBox=\"0 0 " << width
      << ' ' << height << "\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
      << "<g stroke-width=\"" << edge_width << "\" stroke-linejoin=\"round\">\n";
  std::string line;
  for (const Picture::Triangle& t : picture.triangles) {
    line.clear();
    line.append("<polygon fill=\"").append(hex(t.fill)).append("\" stroke=\"").append(hex(t.edge)).append("\" points=\"");
    for (std::size_t i = 0; i < 3; ++i) {
      if (i > 0) line += ' ';
      append(line, t.corners[i]);
    }
    out << line << "\"/>\n";
  }
  out << "</g>\n";
  if (!picture.lines.empty()) {
    out << "<path fill=\"none\" stroke=\"" << hex(ink) << "\" stroke-width=\"" << line_width
        << "\" stroke-linecap=\"round\" d=\"";
    for (const auto& [from, to] : picture.lines) {
      line.assign(1, 'M');
      append(line, from);
      line += 'L';
      append(line, to);
      out << line << '\n';
    }
    out << "\"/>\n";
  }
  out << "</svg>\n";
}

#ifdef PGDR_CAIRO
namespace {

void require(cairo_status_t status, std::ostream& out) {
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  if (status != CAIRO_STATUS_SUCCESS) out.setstate(std::ios::failbit);
}

void set_color(cairo_t* to, const Color& c) { cairo_set_source_rgb(to, c.red / 255.0, c.green / 255.0, c.blue / 255.0); }

cairo_status_t write_bytes(void* out, const unsigned char* bytes, unsigned int size) {
  auto& stream = *static_cast<std::ostream*>(out);
  stream.write(reinterpret_cast<const char*>(bytes), size);
  return stream ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

}  // namespace

bool has_png() { return true; }

void write_png(const Picture& picture, std::ostream& out) {
  const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.width, picture.height), cairo_surface_destroy);
  const std::unique_ptr<cairo_t, void (*)(cairo_t*)> owner(cairo_create(surface.get()), cairo_destroy);
  cairo_t* to = owner.get();
  require(cairo_status(to), out);
  set_color(to, {255, 255, 255});
  cairo_paint(to);
  cairo_set_line_join(to, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(to, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_width(to, edge_width);
  for (const Picture::Triangle& t : picture.triangles) {
    for (const Pixel& p : t.corners) cairo_line_to(to, p[0], p[1]);
    cairo_close_path(to);
    set_color(to, t.fill);
    cairo_fill_preserve(to);
    set_color(to, t.edge);
    cairo_stroke(to);
  }
  cairo_set_line_width(to, line_width);
  set_color(to, ink);
  for (const auto& [a, b] : picture.lines) {
    cairo_move_to(to, a[0], a[1]);
    cairo_line_to(to, b[0], b[1]);
    cairo_stroke(to);
  }
  require(cairo_status(to), out);
  require(cairo_surface_write_to_png_stream(surface.get(), write_bytes, &out), out);
}
#else
bool has_png() { return false; }
void write_png(const Picture&, std::ostream& out) { out.setstate(std::ios::failbit); }
#endif

}  // namespace pgdr::tool
