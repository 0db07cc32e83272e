#include "domain/mesh/polygon_surface.h"

#include <algorithm>
#include <string>

#include "base/counted.h"
#include "base/dense_decompositions.h"
#include "base/index.h"
#include "littoral/error.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

constexpr std::size_t most_corners = 64;  // the operators of a polygon are dense in its corners

/// Does the polygon come back to one of its corners, as one with a hole or a spike does? The same
/// one twice in a row is no way back.
bool comes_back(std::span<const int> corners) {
  std::vector<int> met;
  for (std::size_t k = 0; k < corners.size(); ++k)
    if (corners[k] != corners[(k + 1) % corners.size()]) met.push_back(corners[k]);
  std::sort(met.begin(), met.end());
  return std::adjacent_find(met.begin(), met.end()) != met.end();
}

/// A vertex in the middle sees no such polygon as a whole, or is a corner of it where it is a
/// spike.
bool is_cut(std::span<const int> corners) {
  return corners.size() > most_corners || comes_back(corners);
}

/// A virtual vertex: its affine weights on the corners of its polygon.
VecX virtual_weights(const SurfaceMesh& mesh, std::span<const int> corners) {
  const Eigen::Index n = corners.size();
  Eigen::Matrix3Xd x(3, n);
  for (Eigen::Index i = 0; i < n; ++i) x.col(i) = mesh.point(corners[i]);
  const VecX equal = VecX::Constant(n, 1.0 / static_cast<double>(n));
  const double size = (x.colwise() - x.col(0)).cwiseAbs().maxCoeff();
  if (!(size > 0)) return equal;
  x = (x.colwise() - x.col(0)).eval() / size;
  const Vec3 mean = x.rowwise().mean();
  x.colwise() -= mean;

  // Twice the area of (x, x_i, x_j) is |e x (x - x_i)| with e = x_j - x_i, so that the gradient of
  // the sum of squares vanishes where sum_i (|e|^2 - e e^T) (x - x_i) = 0.
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Vec3 b = Vec3::Zero();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec3 e = x.col((i + 1) % n) - x.col(i);
    const Eigen::Matrix3d Q = e.squaredNorm() * Eigen::Matrix3d::Identity() - e * e.transpose();
    H += Q;
    b += Q * x.col(i);
  }
  const Vec3 centre = solve_symmetric(H, b);

  // Least-norm w with sum w = 1 and x w = centre; the corners are centred, so they part.
  const Eigen::Matrix3d C = x * x.transpose();
  const Eigenvectors3 eigen = symmetric_eigenvectors(C);
  Vec3 y = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    if (eigen.values[k] > 1e-12 * eigen.values[2])
      y += eigen.vectors.col(k) * eigen.vectors.col(k).dot(centre) / eigen.values[k];
  const VecX w = equal + x.transpose() * y;
  return w.allFinite() ? w : equal;
}

/// Adds the triangles of one polygon, cut on its own corners.
void add_triangles(const SurfaceMesh& mesh, std::span<const int> corners, PolygonSoup& to) {
  PolygonSoup one;
  one.points.resize(corners.size(), 3);
  std::vector<int> all(corners.size());
  for (std::size_t k = 0; k < corners.size(); ++k) {
    one.points.row(k) = mesh.point(corners[k]);
    all[k] = k;
  }
  one.add_face(all);
  const PolygonSoup cut = triangulate(one);
  for (int t = 0; t < cut.n_faces(); ++t) {
    const auto c = cut.face(t);
    const int triangle[3] = {corners[c[0]], corners[c[1]], corners[c[2]]};
    to.add_face(triangle);
  }
}

struct Refinement {
  PolygonSoup soup;  // triangles
  Triplets weights;
  std::vector<int> face_offsets{0};
};

Refinement refine(const SurfaceMesh& mesh, Report& report) {
  Refinement out;
  const int n = mesh.n_vertices();
  std::vector<Vec3> added;
  for (int v = 0; v < n; ++v) out.weights.emplace_back(v, v, 1.0);
  int large = 0, returning = 0;
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const auto corners = mesh.face(f);
    if (corners.size() == 3) {
      out.soup.add_face(corners);
    } else if (is_cut(corners)) {
      add_triangles(mesh, corners, out.soup);
      ++(corners.size() > most_corners ? large : returning);
    } else {
      const VecX w = virtual_weights(mesh, corners);
      const int centre = n + int_size(added);
      Vec3 x = Vec3::Zero();
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const double weight = w[k];
        x += weight * (mesh.point(corners[k]) - mesh.point(corners[0]));
        out.weights.emplace_back(centre, corners[k], weight);
        const int triangle[3] = {corners[k], corners[(k + 1) % corners.size()], centre};
        out.soup.add_face(triangle);
      }
      added.push_back(mesh.point(corners[0]) + x);
    }
    out.face_offsets.push_back(out.soup.n_faces());
  }
  if (large)
    report.warn("polygons-cut", counted(large, "polygon", "polygons") + " of more than " +
                                    std::to_string(most_corners) + " corners: cut into triangles");
  if (returning)
    report.warn("polygons-cut", counted(returning, "polygon that comes", "polygons that come") +
                                    " back to a corner: cut into triangles");
  out.soup.points.resize(n + index(added.size()), 3);
  out.soup.points.topRows(n) = mesh.points();
  for (std::size_t i = 0; i < added.size(); ++i) out.soup.points.row(n + index(i)) = added[i];
  return out;
}

void check_orientable(const IntrinsicTriangulation& T) {
  for (int t = 0; t < T.n_faces(); ++t)
    for (int k = 0; k < 3; ++k)
      if (T.seam(t, k) && T.edge_use[T.side_edge(t, k)] == 2)
        throw UnsupportedError(
            "the polygon mesh is not orientable; cut into triangles, the methods run on "
            "it");
}

double mean_edge_length(const SurfaceMesh& mesh, double unit) {
  double sum = 0;
  for (int e = 0; e < mesh.n_edges(); ++e)
    sum += (mesh.point(mesh.edges()(e, 1)) / unit - mesh.point(mesh.edges()(e, 0)) / unit).norm();
  return sum / mesh.n_edges();
}

/// Everything but normals.
NodalSurface refined_surface(const SurfaceMesh& mesh, Report& report) {
  Refinement fine = refine(mesh, report);
  NodalSurface S;
  S.face_offsets = std::move(fine.face_offsets);
  S.refined = std::make_shared<const SurfaceMesh>(std::move(fine.soup));
  auto cells =
      std::make_shared<IntrinsicTriangulation>(intrinsic_triangulation(*S.refined, report));
  check_orientable(*cells);
  S.spacing = mean_edge_length(mesh, cells->unit);
  cells->mean_edge_length = S.spacing;
  S.place = S.cells = cells;
  S.weight = VecX::Ones(cells->n_faces());
  S.P.resize(S.refined->n_vertices(), mesh.n_vertices());
  S.P.setFromTriplets(fine.weights.begin(), fine.weights.end());
  S.patch_offsets.assign(1, 0);
  for (int f = 0; f < mesh.n_faces(); ++f) {
    int n = 0;
    for (int t = S.face_offsets[f]; t < S.face_offsets[f + 1]; ++t)
      n += cells->triangle_of_face[t] >= 0;
    if (is_cut(mesh.face(f)))
      for (int k = 1; k <= n; ++k) S.patch_offsets.push_back(S.patch_offsets.back() + 1);
    else if (n)
      S.patch_offsets.push_back(S.patch_offsets.back() + n);
  }
  return S;
}

}  // namespace

NodalSurface polygon_surface(const SurfaceMesh& mesh, Report& report) {
  NodalSurface S = refined_surface(mesh, report);
  S.domain = "polygon mesh";
  S.patch_normals.resize(S.n_patches(), 3);
  for (int p = 0; p < S.n_patches(); ++p) {
    Vec3 sum = Vec3::Zero();
    for (int c = S.patch_offsets[p]; c < S.patch_offsets[p + 1]; ++c)
      sum += area_vector(*S.refined, *S.cells, c);
    S.patch_normals.row(p) = normalized_or_z(sum);
  }
  S.normals = vertex_area_vectors(*S.refined, *S.cells).topRows(mesh.n_vertices());
  for (auto n : S.normals.rowwise()) n = normalized_or_z(n.transpose()).transpose();
  return S;
}

NodalSurface voxel_surface(const SurfaceMesh& mesh, const MatX3& face_normals, Report& report) {
  NodalSurface S = refined_surface(mesh, report);
  S.domain = "voxel surface";
  S.patch_normals = face_normals;
  S.normals = MatX3::Zero(mesh.n_vertices(), 3);
  for (int f = 0; f < mesh.n_faces(); ++f)
    for (int v : mesh.face(f)) S.normals.row(v) += face_normals.row(f);
  for (auto n : S.normals.rowwise()) n = normalized_or_z(n.transpose()).transpose();

  // Lengths as seen along the corrected normal: each surfel becomes its projection (Coeurjolly and
  // Lachaud 2022, section 3).
  auto cells = std::make_shared<IntrinsicTriangulation>(*S.cells);
  for (int p = 0; p < S.n_patches(); ++p) {
    const Vec3 u = S.patch_normals.row(p);
    for (int c = S.patch_offsets[p]; c < S.patch_offsets[p + 1]; ++c) {
      for (int k = 0; k < 3; ++k) {
        const Vec3 side = S.refined->point(cells->faces(c, (k + 1) % 3)) / cells->unit -
                          S.refined->point(cells->faces(c, k)) / cells->unit;
        cells->length(c, k) = (side - side.dot(u) * u).norm();
      }
      cells->orientation[c] = area_vector(*S.refined, *S.cells, c).dot(u) > 0
                                  ? S.cells->orientation[c]
                                  : static_cast<std::int8_t>(-S.cells->orientation[c]);
    }
  }
  S.cells = cells;
  return S;
}

}  // namespace littoral
