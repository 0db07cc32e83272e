#pragma once
// What tests of repairs look at.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>

#include "api/surface/mesh_info.h"
#include "littoral/mesh.h"
#include "report_helpers.h"

namespace littoral::test {

inline double fact(const PolygonSoup& soup, const std::string& key) {
  for (const InfoEntry& each : surface_info(soup))
    if (each.key == key)
      return std::holds_alternative<bool>(each.value) ? double(std::get<bool>(each.value))
                                                      : std::get<double>(each.value);
  ADD_FAILURE() << key;
  return NAN;
}

inline double volume_of(const PolygonSoup& soup) {
  double volume = 0;
  for (int f = 0; f < soup.n_faces(); ++f) {
    const Vec3 a = soup.points.row(soup.face(f)[0]), b = soup.points.row(soup.face(f)[1]),
               c = soup.points.row(soup.face(f)[2]);
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

inline void expect_watertight(const Mesh& mesh) {
  EXPECT_EQ(fact(mesh.soup(), "watertight"), 1);
  EXPECT_EQ(fact(mesh.soup(), "nonmanifold_vertices"), 0);
}

}  // namespace littoral::test
