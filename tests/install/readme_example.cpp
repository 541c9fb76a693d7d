#include <pgdr/pgdr.hpp>

int main() {
  pgdr::Plc<3> plc = pgdr::read_plc<3>("tests/models/bracket.poly");  // or fill it from memory
  pgdr::RefineOptions<3> options;
  options.radius_edge_bound = 2.0;
  options.size = [](const pgdr::Point3& p) { return 0.1 + 0.1 * p[2]; };  // finer at the bottom
  auto result = pgdr::refine(plc, options);  // mesh, statistics, what stayed poor and why; throws pgdr::Error
  pgdr::write_mesh(result.mesh, "bracket.vtu");
}
