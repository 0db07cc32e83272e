#include "domains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace littoral::fuzz {

namespace {

void add(PolygonSoup& soup, std::initializer_list<int> face) {
  soup.add_face(std::vector<int>(face));
}

int add_vertex(PolygonSoup& soup, const Vec3& x) {
  const auto n = soup.points.rows();
  soup.points.conservativeResize(n + 1, 3);
  soup.points.row(n) = x;
  return static_cast<int>(n);
}

Vec3 random_point(Choices& choose) {
  const double x = choose.unit(), y = choose.unit(), z = choose.unit();
  return {2 * x - 1, 2 * y - 1, 2 * z - 1};
}

PolygonSoup grid(Choices& choose) {
  const int nx = choose.between(1, 5), ny = choose.between(1, 5);
  PolygonSoup soup;
  const double bend = choose.chance(0.5) ? choose.unit() : 0;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
      add_vertex(soup, {double(i) / nx, double(j) / ny, bend * choose.unit()});
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int a = i + j * (nx + 1), b = a + 1, c = a + nx + 1, d = c + 1;
      add(soup, {a, b, d});
      add(soup, {a, d, c});
    }
  return soup;
}

/// Pages that share a spine.
PolygonSoup book(Choices& choose) {
  PolygonSoup soup;
  add_vertex(soup, {0, 0, 0});
  add_vertex(soup, {0, 0, 1});
  const int pages = choose.between(3, 6);
  for (int k = 0; k < pages; ++k) {
    const double turn = 6.283185307179586 * k / pages;
    const Vec3 out(std::cos(turn), std::sin(turn), 0);
    const int c = add_vertex(soup, out), d = add_vertex(soup, out + Vec3(0, 0, 1));
    add(soup, {0, c, 1});
    add(soup, {1, c, d});
  }
  return soup;
}

/// Triangles between random vertices: any of them may share an edge, or a vertex twice.
PolygonSoup soup_of(Choices& choose) {
  PolygonSoup soup;
  const int n = choose.between(3, 20), faces = choose.between(1, 30);
  for (int v = 0; v < n; ++v) add_vertex(soup, random_point(choose));
  for (int f = 0; f < faces; ++f) {
    const int a = choose.below(n), b = choose.below(n), c = choose.below(n);
    add(soup, {a, b, c});
  }
  return soup;
}

PolygonSoup closed(Choices& choose) {
  PolygonSoup soup;
  if (choose.chance(0.5)) {
    for (const Vec3& x : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)})
      add_vertex(soup, x);
    for (const auto& f : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) soup.add_face(f);
    return soup;
  }
  for (int k = 0; k < 3; ++k)
    for (const int side : {1, -1}) add_vertex(soup, side * Vec3::Unit(k));
  for (const auto& f : {std::array{0, 2, 4},
                        {2, 1, 4},
                        {1, 3, 4},
                        {3, 0, 4},
                        {2, 0, 5},
                        {1, 2, 5},
                        {3, 1, 5},
                        {0, 3, 5}})
    soup.add_face(f);
  return soup;
}

/// A fan whose triangles get thinner and thinner.
PolygonSoup needles(Choices& choose) {
  PolygonSoup soup;
  add_vertex(soup, {0, 0, 0});
  const int n = choose.between(2, 12);
  const double thin = std::pow(10.0, -choose.between(1, 12));
  for (int k = 0; k <= n; ++k) {
    const double turn = k * (choose.chance(0.5) ? thin : 0.5);
    add_vertex(soup, {std::cos(turn), std::sin(turn), choose.chance(0.2) ? thin : 0});
  }
  for (int k = 0; k < n; ++k) add(soup, {0, 1 + k, 2 + k});
  return soup;
}

/// The other soup's points, scaled and moved, and its faces.
void append(PolygonSoup& soup, const PolygonSoup& other, double scale, const Vec3& by) {
  const int n = soup.n_vertices();
  soup.points.conservativeResize(n + other.n_vertices(), 3);
  for (int v = 0; v < other.n_vertices(); ++v)
    soup.points.row(n + v) = scale * other.points.row(v) + by.transpose();
  for (int f = 0; f < other.n_faces(); ++f) {
    std::vector<int> face;
    for (const int v : other.face(f)) face.push_back(n + v);
    soup.add_face(face);
  }
}

/// What is done to faces and vertices of a sound mesh.
void damage(Choices& choose, PolygonSoup& soup) {
  const auto a_face = [&] {
    const auto corners = soup.face(choose.below(soup.n_faces()));
    return std::vector<int>(corners.begin(), corners.end());
  };
  for (int k = choose.below(4); k > 0; --k) {
    std::vector<int> face = a_face();
    switch (choose.below(6)) {
      case 0:  // a second time, perhaps the other way round
        if (choose.chance(0.5)) std::reverse(face.begin(), face.end());
        soup.add_face(face);
        break;
      case 1:  // one that repeats a vertex
        face[1] = face[0];
        soup.add_face(face);
        break;
      case 2:  // one without area, over an edge
        add(soup, {face[0], face[1],
                   add_vertex(soup, 0.5 * (soup.points.row(face[0]) + soup.points.row(face[1])))});
        break;
      case 3:  // corners at one point
        soup.points.row(face[1]) = soup.points.row(face[0]);
        break;
      case 4:  // a fin
        add(soup, {face[0], face[1], add_vertex(soup, random_point(choose))});
        break;
      default:  // a vertex in no face
        add_vertex(soup, random_point(choose));
    }
  }
}

SurfacePoint random_place(Choices& choose, const PolygonSoup& soup, int n_edges) {
  const int kind = choose.below(3);
  const double t = choose.chance(0.2) ? 0 : choose.chance(0.2) ? 1 : choose.unit();
  if (kind == 1 && n_edges > 0) return SurfacePoint::on_edge(choose.below(n_edges), t);
  if (kind == 2 && soup.n_faces() > 0) {
    const double s = choose.chance(0.2) ? 0 : choose.unit();
    return SurfacePoint::in_face(choose.below(soup.n_faces()), 1 - t, t * (1 - s), t * s);
  }
  return SurfacePoint::at_vertex(choose.below(soup.n_vertices()));
}

}  // namespace

PolygonSoup random_triangles(Choices& choose) {
  const auto one = [&] {
    switch (choose.below(6)) {
      case 0:
        return book(choose);
      case 1:
        return soup_of(choose);
      case 2:
        return closed(choose);
      case 3:
        return needles(choose);
      default:
        return grid(choose);
    }
  };
  PolygonSoup soup = one();
  if (choose.chance(0.3)) {
    const double scale = std::pow(10.0, -choose.between(0, 5));
    append(soup, one(), scale, choose.chance(0.5) ? Vec3(5, 0, 0) : Vec3(0, 0, 0));
  }
  if (choose.chance(0.4)) damage(choose, soup);
  return soup;
}

PolygonSoup random_polygons(Choices& choose) {
  const int nx = choose.between(1, 4), ny = choose.between(1, 4);
  PolygonSoup soup;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
      add_vertex(soup, {double(i) / nx, double(j) / ny, 0.2 * choose.unit()});
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int a = i + j * (nx + 1), b = a + 1, c = a + nx + 1, d = c + 1;
      if (choose.chance(0.2))
        add(soup, {a, b, d, c,
                   add_vertex(soup, soup.points.row(a) +
                                        0.1 * (soup.points.row(c) - soup.points.row(a)))});
      else
        add(soup, {a, b, d, c});
    }
  if (choose.chance(0.3)) append(soup, closed(choose), choose.chance(0.5) ? 1 : 1e-4, {3, 0, 0});
  if (choose.chance(0.3)) damage(choose, soup);
  return soup;
}

PolygonSoup random_cloud(Choices& choose) {
  PolygonSoup soup;
  const int n = choose.between(1, 40), shape = choose.below(3);
  for (int v = 0; v < n; ++v) {
    Vec3 x = random_point(choose);
    if (shape == 0 && x.norm() > 0) x.normalize();
    if (shape == 1) x[2] = 0;
    if (v > 0 && choose.chance(0.1)) x = soup.points.row(v - 1);
    add_vertex(soup, x);
  }
  if (choose.chance(0.6)) {
    soup.normals = soup.points;
    if (choose.chance(0.2)) soup.normals.row(0).setZero();
  }
  return soup;
}

TetMesh random_tets(Choices& choose) {
  TetMesh mesh;
  const int n = choose.between(1, 2), m = n + 1;
  const int boxes = choose.chance(0.3) ? 2 : 1;
  const double smaller = std::pow(10.0, -choose.between(0, 5));
  mesh.points.resize(boxes * m * m * m, 3);
  mesh.tets.resize(6 * n * n * n * boxes, 4);
  int t = 0;
  for (int box = 0; box < boxes; ++box) {
    const int first = box * m * m * m;
    for (int v = 0; v < m * m * m; ++v) {
      const Vec3 x = Vec3(v % m, v / m % m, v / m / m) + 0.2 * random_point(choose);
      mesh.points.row(first + v) = box == 0 ? x : Vec3(smaller * x + Vec3(5, 0, 0));
    }
    for (int cube = 0; cube < n * n * n; ++cube) {
      const int corner = cube % n + m * (cube / n % n + m * (cube / n / n));
      const auto at = [&](int bits) {
        return first + corner + (bits & 1) + m * ((bits >> 1 & 1) + m * (bits >> 2));
      };
      for (const auto& [a, b] : {std::array{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}}) {
        mesh.tets.row(t) << at(0), at(a), at(b), at(7);
        if (choose.chance(0.05)) std::swap(mesh.tets(t, 0), mesh.tets(t, 1));
        if (choose.chance(0.03)) mesh.tets(t, 0) = mesh.tets(t, 1);
        ++t;
      }
    }
  }
  return mesh;
}

Sources random_sources(Choices& choose, const PolygonSoup& soup, int n_edges) {
  Sources sources;
  if (choose.chance(0.02)) return sources;
  if (choose.chance(0.05)) {  // every vertex
    for (int v = 0; v < soup.n_vertices(); ++v) sources.add(SurfacePoint::at_vertex(v));
    return sources;
  }
  const int points = choose.chance(0.6) ? choose.between(1, 4) : 0;
  for (int k = 0; k < points; ++k) sources.add(random_place(choose, soup, n_edges));
  const int curves = points == 0 || choose.chance(0.2) ? choose.between(1, 2) : 0;
  for (int k = 0; k < curves; ++k) {
    Curve curve;
    const bool along = soup.n_faces() > 0 && choose.chance(0.5);
    if (along) {  // round a face or a part of it
      const auto face = soup.face(choose.below(soup.n_faces()));
      const int nodes = choose.between(2, static_cast<int>(face.size()));
      for (int i = 0; i < nodes; ++i) curve.nodes.push_back(SurfacePoint::at_vertex(face[i]));
    } else {
      for (int i = choose.between(2, 4); i > 0; --i)
        curve.nodes.push_back(random_place(choose, soup, n_edges));
    }
    if (choose.chance(0.4)) curve.nodes.push_back(curve.nodes.front());
    curve.is_signed = choose.chance(0.6);
    sources.add(std::move(curve));
  }
  if (choose.chance(0.03)) sources.add(SurfacePoint::at_vertex(soup.n_vertices() + 3));
  if (choose.chance(0.02)) sources.add(SurfacePoint::in_face(0, NAN, 0.5, 0.5));
  if (choose.chance(0.02)) sources.add(SurfacePoint::on_edge(n_edges, 0.5));
  if (choose.chance(0.03)) {
    SpaceCurve curve;
    curve.points = MatX3(3, 3);
    for (int i = 0; i < 3; ++i) curve.points.row(i) = random_point(choose);
    sources.add(std::move(curve));
  }
  return sources;
}

TetSources random_tet_sources(Choices& choose, const TetMesh& mesh) {
  TetSources sources;
  switch (choose.below(4)) {
    case 0:
      sources.boundary = true;
      break;
    case 1: {
      sources.surface = random_triangles(choose);
      break;
    }
    case 2:
      sources.surface = random_cloud(choose);
      break;
    default:
      for (int k = choose.between(0, 5); k > 0; --k)
        sources.vertices.push_back(choose.below(mesh.n_vertices()));
      if (choose.chance(0.05)) sources.vertices.push_back(mesh.n_vertices());
  }
  sources.flip = choose.chance(0.2);
  sources.estimate_normals = choose.chance(0.2);
  if (choose.chance(0.25)) {
    const PolygonSoup& surface = sources.surface;
    int n = surface.n_faces() > 0 ? surface.n_faces() : surface.n_vertices();
    if (n == 0) n = static_cast<int>(sources.vertices.size()) + (sources.boundary ? 1 : 0);
    if (choose.chance(0.3)) n = choose.below(3);
    for (int i = 0; i < n; ++i) sources.values.push_back(0.4 * (choose.below(3) - 1));
    if (choose.chance(0.02)) sources.values.push_back(NAN);
  }
  return sources;
}

}  // namespace littoral::fuzz
