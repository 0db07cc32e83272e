#include "api/space/tori_cloud.h"

#include <array>
#include <cmath>
#include <string>

#include "base/index.h"
#include "littoral/error.h"

namespace littoral {

namespace {

constexpr std::array<const char*, 10> names = {"torus_qx",  "torus_qy",    "torus_qz", "torus_e1x",
                                               "torus_e1y", "torus_e1z",   "torus_k1", "torus_k2",
                                               "torus_rho", "torus_weight"};

}  // namespace

PolygonSoup cloud_of_tori(const MatX3& points, const std::vector<Torus>& tori) {
  PolygonSoup cloud;
  cloud.points = points;
  cloud.normals.resize(points.rows(), 3);
  std::array<VecX*, names.size()> columns{};
  for (std::size_t c = 0; c < names.size(); ++c) {
    columns[c] = &cloud.scalars[names[c]];
    columns[c]->resize(points.rows());
  }
  for (std::size_t i = 0; i < tori.size(); ++i) {
    const Torus& t = tori[i];
    const auto row = index(i);
    cloud.normals.row(row) = t.n;
    const std::array<double, names.size()> values = {
        t.q[0], t.q[1], t.q[2], t.e1[0], t.e1[1], t.e1[2], t.k1, t.k2, t.rho, t.log_weight};
    for (std::size_t c = 0; c < names.size(); ++c) (*columns[c])[row] = values[c];
  }
  return cloud;
}

bool has_tori(const PolygonSoup& cloud) {
  if (cloud.n_faces() > 0 || cloud.normals.rows() == 0) return false;
  for (const char* name : names)
    if (cloud.scalars.count(name) == 0) return false;
  return true;
}

std::vector<Torus> tori_of_cloud(const PolygonSoup& cloud) {
  std::vector<Torus> tori(std::size_t(cloud.n_vertices()));
  for (std::size_t i = 0; i < tori.size(); ++i) {
    const auto row = index(i);
    std::array<double, names.size()> v{};
    bool finite = cloud.points.row(row).allFinite() && cloud.normals.row(row).allFinite();
    for (std::size_t c = 0; c < names.size(); ++c) {
      v[c] = cloud.scalars.at(names[c])[row];
      finite = finite && std::isfinite(v[c]);
    }
    Torus& t = tori[i];
    const Vec3 n = cloud.normals.row(row), e1(v[3], v[4], v[5]);
    t.n = n.stableNormalized();
    t.e1 = (e1 - e1.dot(t.n) * t.n).stableNormalized();
    if (!finite || !(t.n.norm() > 0.5) || !(t.e1.norm() > 0.5) || !(v[8] > 0) || v[9] > 0)
      throw InputError("the torus of point " + std::to_string(i) + " has unusable numbers",
                       "not-finite");
    t.q = Vec3(v[0], v[1], v[2]);
    t.k1 = v[6];
    t.k2 = v[7];
    t.rho = v[8];
    t.log_weight = v[9];
  }
  return tori;
}

}  // namespace littoral
