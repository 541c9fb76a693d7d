// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "trace.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "json.hpp"
#include "pgdr/output_files.hpp"

namespace pgdr::tool {
namespace {

constexpr int process = 1, row_of_phases = 0, row_of_stages = 1;
int row_of_thread(std::uint32_t thread) { return static_cast<int>(thread) + 2; }

/// Events, one a line.
class Events {
 public:
  explicit Events(std::ostream& out) : out_(out) {}

  void name_row(int row, const std::string& name) {
    put({{"name", "thread_name"}, {"ph", "M"}, {"pid", process}, {"tid", row}, {"args", JsonObject{{"name", name}}}});
    put({{"name", "thread_sort_index"}, {"ph", "M"}, {"pid", process}, {"tid", row}, {"args", JsonObject{{"sort_index", row}}}});
  }
  /// Both ends are rounded to nanoseconds, which keeps slices that follow each other from overlapping.
  void slice(int row, const std::string& name, double start, double end, const JsonObject& arguments) {
    const double from = std::round(start * 1e9), to = std::max(from, std::round(end * 1e9));
    put({{"name", name},
         {"ph", "X"},
         {"pid", process},
         {"tid", row},
         {"ts", from / 1000},
         {"dur", (to - from) / 1000},
         {"args", arguments}});
  }

 private:
  void put(const JsonObject& event) {
    out_ << (first_ ? "" : ",\n") << Json(event).text();
    first_ = false;
  }

  std::ostream& out_;
  bool first_ = true;
};

void put_visit(Events& events, const VisitTrace& v, double mesh_at) {
  const bool whole = v.order == VisitTrace::whole_tree;
  const std::string name = whole ? "whole tree" : "leaf " + std::to_string(v.leaf) + " L" + std::to_string(v.level);
  events.slice(row_of_thread(v.thread), name, mesh_at + v.start, mesh_at + v.end,
               {{"generation", v.generation},
                {"order", whole ? Json("whole tree") : Json(v.order)},
                {"committed", v.committed},
                {"set_aside", v.set_aside}});
}

}  // namespace

void write_trace(const std::string& file, std::span<const Phase> phases, std::span<const StageTime> stages,
                 std::span<const VisitTrace> visits, double mesh_at) {
  std::uint32_t threads = 0;
  for (const VisitTrace& v : visits) threads = std::max(threads, v.thread + 1);
  write_file(file, [&](std::ostream& out) {
    out << "{\"displayTimeUnit\": \"ms\", \"traceEvents\": [\n";
    Events events(out);
    events.name_row(row_of_phases, "phases");
    events.name_row(row_of_stages, "stages");
    for (std::uint32_t t = 0; t < threads; ++t) events.name_row(row_of_thread(t), "thread " + std::to_string(t));
    for (const Phase& p : phases) events.slice(row_of_phases, p.name, p.start, p.end, {});
    for (const StageTime& s : stages) events.slice(row_of_stages, s.name, mesh_at + s.start, mesh_at + s.start + s.seconds, {});
    for (const VisitTrace& v : visits) put_visit(events, v, mesh_at);
    out << "\n]}\n";
  });
}

}  // namespace pgdr::tool
