// Winding numbers of soups: microseconds a query, and errors beside the sum of all solid angles.
// usage: littoral_soup_speed [--queries N] [--checked N] DAMAGE:MESH...
//        DAMAGE: as-is; flipped (one face in seven reversed, one in fifty left out); apart (every
//        face on its own, moved by up to a tenth of its size); doubled (each face twice, the second
//        moved likewise and reversed for one in three); strewn (as many faces of that size anywhere
//        in the box)
// Queries are drawn from the box and a tenth of it around, and on faces, moved by a normal deviate
// of 1 % of the mesh's size along each axis. Processor time of one thread, points in order, the
// least of three, one by one and together; errors of N of them beside the sum of all angles. To
// compare two versions take turns.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "io/read.h"
#include "littoral/error.h"
#include "spatial/morton_order.h"
#include "spatial/triangulate.h"
#include "spatial/winding_number.h"

namespace littoral {
namespace {

struct Soup {
  MatX3 points;
  MatX3i faces;
};

class Draw {
 public:
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3 within(const Vec3& low, const Vec3& high) {
    Vec3 x;
    for (int k = 0; k < 3; ++k) x[k] = (*this)(low[k], high[k]);
    return x;
  }
  double normal() { return std::normal_distribution<double>()(random_); }
  std::mt19937& generator() { return random_; }

 private:
  std::mt19937 random_{1};
};

Soup damaged(const std::string& damage, const Soup& s) {
  Draw draw;
  const Eigen::Index m = s.faces.rows();
  Soup out = s;
  if (damage == "as-is") return out;
  if (damage == "flipped") {
    Eigen::Index kept = 0;
    for (Eigen::Index f = 0; f < m; ++f) {
      if (f % 50 == 0) continue;
      out.faces.row(kept) = s.faces.row(f);
      if (f % 7 == 0) std::swap(out.faces(kept, 0), out.faces(kept, 1));
      ++kept;
    }
    out.faces.conservativeResize(kept, 3);
    return out;
  }
  const int copies = damage == "doubled" ? 2 : 1;
  out.points.resize(3 * copies * m, 3);
  out.faces.resize(copies * m, 3);
  const Vec3 low = s.points.colwise().minCoeff(), high = s.points.colwise().maxCoeff();
  for (Eigen::Index i = 0; i < copies * m; ++i) {
    const Eigen::Index f = i % m;
    const double size = (s.points.row(s.faces(f, 1)) - s.points.row(s.faces(f, 0))).norm();
    Vec3 shift = draw.within(Vec3::Constant(-0.1 * size), Vec3::Constant(0.1 * size));
    if (damage == "doubled" && i < m) shift.setZero();
    if (damage == "strewn") shift = draw.within(low, high) - Vec3(s.points.row(s.faces(f, 0)));
    for (int k = 0; k < 3; ++k) {
      out.points.row(3 * i + k) = s.points.row(s.faces(f, k)) + shift.transpose();
      out.faces(i, k) = static_cast<int>(3 * i + k);
    }
    if (damage == "doubled" && i >= m && i % 3 == 0) std::swap(out.faces(i, 0), out.faces(i, 1));
  }
  return out;
}

double seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

void measure(const WindingNumber& winding, const MatX3& unordered, int checked, double building,
             const std::string& name) {
  const std::vector<int> order = morton_order(unordered);
  MatX3 queries(unordered.rows(), 3);
  for (Eigen::Index i = 0; i < queries.rows(); ++i) queries.row(i) = unordered.row(order[i]);
  VecX value(queries.rows()), side(queries.rows()), together;
  const double n = double(queries.rows());
  double took = std::numeric_limits<double>::infinity(), took_side = took, took_together = took;
  for (int round = 0; round < 3; ++round) {
    const double begin = seconds();
    for (Eigen::Index i = 0; i < queries.rows(); ++i) value[i] = winding(queries.row(i));
    const double middle = seconds();
    for (Eigen::Index i = 0; i < queries.rows(); ++i)
      side[i] = winding(queries.row(i), WindingNumber::sign_accuracy);
    const double end = seconds();
    together = winding.at(queries, Task());
    took = std::min(took, middle - begin);
    took_side = std::min(took_side, end - middle);
    took_together = std::min(took_together, seconds() - end);
  }
  std::vector<int> some(queries.rows());
  for (std::size_t i = 0; i < some.size(); ++i) some[i] = static_cast<int>(i);
  std::shuffle(some.begin(), some.end(), Draw().generator());
  some.resize(std::min<std::size_t>(some.size(), checked));
  std::vector<double> error;
  double sum = 0, worst_side = 0, sum_together = 0, worst_together = 0;
  for (int i : some) {
    const double exact = winding(queries.row(i), std::numeric_limits<double>::infinity());
    error.push_back(std::abs(value[i] - exact));
    sum += error.back();
    const double off = std::abs(together[i] - exact);
    sum_together += off;
    worst_together = std::max(worst_together, off);
    worst_side = std::max(worst_side, std::abs(side[i] - exact));
  }
  std::sort(error.begin(), error.end());
  std::printf("| %s | %.3f | %.2f | %.2f | %.1e | %.1e | %.1e | %.1e | %.2f | %.1e | %.1e |%s\n",
              name.c_str(), building, 1e6 * took / n, 1e6 * took_side / n,
              sum / double(error.size()),
              error[static_cast<std::size_t>(0.999 * double(error.size()))], error.back(),
              worst_side, 1e6 * took_together / n, sum_together / double(error.size()),
              worst_together, winding.exact() ? " exact" : "");
  std::fflush(stdout);
}

void run(const std::string& word, int count, int checked) {
  const std::size_t colon = word.find(':');
  if (colon == std::string::npos) throw std::runtime_error("not DAMAGE:MESH: " + word);
  const PolygonSoup read = triangulate(io::read_surface(word.substr(colon + 1)));
  const Soup soup = damaged(word.substr(0, colon), {read.points, triangles_of(read)});
  const double begin = seconds();
  const WindingNumber winding(soup.points, soup.faces, WindingNumber::Queries::together);
  const double building = seconds() - begin;
  Draw draw;
  const Vec3 low = soup.points.colwise().minCoeff(), high = soup.points.colwise().maxCoeff();
  const double size = (high - low).maxCoeff();
  MatX3 box(count, 3), near(count, 3);
  for (int i = 0; i < count; ++i) {
    box.row(i) =
        draw.within(low - Vec3::Constant(size / 10), high + Vec3::Constant(size / 10)).transpose();
    const auto f = static_cast<Eigen::Index>(draw(0, double(soup.faces.rows())));
    double u = draw(0, 1), v = draw(0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto corner = [&](int k) { return Vec3(soup.points.row(soup.faces(f, k))); };
    const Vec3 away(draw.normal(), draw.normal(), draw.normal());
    near.row(i) =
        corner(0) + u * (corner(1) - corner(0)) + v * (corner(2) - corner(0)) + size / 100 * away;
  }
  const std::string name = word.substr(0, colon + 1) +
                           std::filesystem::path(word.substr(colon + 1)).stem().string() + ", " +
                           std::to_string(soup.faces.rows());
  measure(winding, box, checked, building, name + ", box");
  measure(winding, near, checked, building, name + ", near");
}

}  // namespace
}  // namespace littoral

int main(int count, char** words) try {
  int queries = 100000, checked = 1500;
  std::printf(
      "| soup, faces, queries | building, s | us | side, us | mean error | 99.9 %% | largest "
      "| of sides | together, us | mean error | largest |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  littoral::set_thread_count(1);
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    if (word == "--queries" && i + 1 < count)
      queries = std::atoi(words[++i]);
    else if (word == "--checked" && i + 1 < count)
      checked = std::atoi(words[++i]);
    else
      littoral::run(word, queries, checked);
  }
} catch (const littoral::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
