#pragma once
// A triangulation that can be flipped and split, with curves drawn on it.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "domain/intrinsic/intrinsic_delaunay.h"

namespace littoral {

/// How far from collinear triangles stay, in units of their longest side.
constexpr double collinear_margin = 1e-10;

/// The faces of an edge, few as a rule.
class FacesOfEdge {
 public:
  FacesOfEdge() = default;
  FacesOfEdge(std::initializer_list<int> faces) {
    for (const int f : faces) push_back(f);
  }

  std::size_t size() const { return n_; }
  bool empty() const { return n_ == 0; }
  int* begin() { return n_ <= first_.size() ? first_.data() : all_.data(); }
  int* end() { return begin() + n_; }
  const int* begin() const { return n_ <= first_.size() ? first_.data() : all_.data(); }
  const int* end() const { return begin() + n_; }
  int operator[](std::size_t i) const { return begin()[i]; }

  void push_back(int f) {
    if (n_ == first_.size()) all_.assign(first_.begin(), first_.end());
    if (n_ < first_.size())
      first_[n_] = f;
    else
      all_.push_back(f);
    ++n_;
  }
  void clear() { n_ = 0; }

 private:
  std::array<int, 2> first_{};
  std::uint32_t n_ = 0;
  std::vector<int> all_;  // where there are more
};

/// Triangles of three different vertices, glued along edges of given length; several edges may join
/// two vertices. Corners run counter-clockwise seen from the side of the orientation, as far as
/// there is one.
class IntrinsicMeshEditor {
 public:
  struct Face {
    std::array<int, 3> v, e;       // corners; edge of side k, from corner k to k + 1
    std::array<int, 3> side_sign;  // on which side of the edge the face lies, +1 or -1
  };
  struct Edge {
    int tail, head;
    double length;
    FacesOfEdge faces;
  };

  IntrinsicMeshEditor(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                      CurveNetwork curves);

  /// Sum of the cotangents opposite an edge, over all its faces: twice its weight in the cotan
  /// Laplacian; +infinity without a face.
  double delaunay_sum(int e) const;
  /// Can the edge not be flipped whatever its triangles' shapes? One with more or fewer than two,
  /// or with two that have no common orientation, or one to be kept.
  bool fixed(int e) const;
  /// Flips an edge if its two triangles allow it.
  bool flip(int e);
  /// Puts a vertex in the middle of an edge if that leaves its triangles an area.
  bool split(int e);
  TriangleShape shape(int f) const;
  /// Lets the processor read ahead what `delaunay_sum` needs, in steps of which each looks at what
  /// the one before has fetched.
  static constexpr int n_fetch_steps = 3;
  void fetch(int e, int step) const;
  int longest_edge(int f) const;

  /// The result, with connectivity and frames of its own.
  Retriangulation finish(const IntrinsicTriangulation& before) &&;

  std::vector<Face> faces;
  std::vector<Edge> edges;
  std::vector<char> keep;  // the first edges: never flipped
  int n_vertices() const { return points_.size(); }

 private:
  /// What is drawn in some triangles, with positions in their common plane.
  struct Drawing {
    std::vector<std::pair<int, Complex>> inside;  // nodes that lie in no other triangle
    struct Stroke {
      CurveNetwork::Segment segment;
      Complex a, b;
    };
    std::vector<Stroke> strokes;
  };
  using Corners = std::array<Complex, 3>;

  Drawing lift(const std::vector<std::pair<int, Corners>>& layout, int edge);
  void place(const Drawing& drawing, int edge, int left, const Corners& at_left, int right,
             const Corners& at_right);
  Complex position(const SurfacePoint& p, const std::vector<std::pair<int, Corners>>& layout) const;
  void add_segment(CurveNetwork::Segment segment);
  int side_of(int f, int e) const;

  std::vector<Vec3> points_;
  std::vector<SurfacePoint> nodes_;  // of what is drawn; if there are none, what follows is empty
  std::vector<std::vector<int>> nodes_in_face_, nodes_on_edge_;
  std::vector<std::vector<CurveNetwork::Segment>> in_face_, on_edge_;
};

}  // namespace littoral
