#include "methods/implicit/settled_sides.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "base/option_table.h"
#include "base/stopwatch.h"
#include "methods/implicit/orient_soup.h"
#include "spatial/boundary_edges.h"

namespace littoral {

namespace {

constexpr double doubtful = 0.02;  // share of the area with the outside on both sides
constexpr double walls = 0.05;     // with the inside on both sides
constexpr double nothing = 0.01;   // share of the area that bounds
constexpr double sure = 0.8;       // lines for the orientation, less those against
constexpr double few = 0.001;      // of the area, turned

void report_shares(const SideCensus::Shares& shares, Report& report) {
  report.sizes.emplace_back("share of the area that bounds", shares.bounds);
  report.sizes.emplace_back("share of the area inside on both sides", shares.within);
  report.sizes.emplace_back("share of the area outside on both sides", shares.without);
  if (shares.bounds < nothing) {
    report.status = "uncertain";
    report.warn(
        "nothing-enclosed",
        "the input encloses nothing, so there is no inside: it is a sheet, or too many faces are "
        "missing; method signed-heat closes sheets that are consistently oriented");
    return;
  }
  if (shares.without > doubtful) {
    report.status = "uncertain";
    report.warn(
        "sheets",
        percent_text(shares.without) +
            " of the input's area has the outside on both sides: sheets, or faces that are "
            "double or reversed; signs are uncertain there. Orient faces consistently, leave "
            "out double ones and fill holes, or look whether method signed-heat agrees");
  }
  if (shares.within > walls)
    report.warn(
        "walls-inside",
        percent_text(shares.within) +
            " of the input's area lies inside, on both sides: walls within, or parts that "
            "overlap. Distances inside are to the nearest of them; leave them out to measure "
            "to the outer surface alone");
}

void report_orientation(const OrientedSoup& soup, Report& report) {
  report.sizes.emplace_back("share of the area turned", soup.turned);
  report.sizes.emplace_back("share of the area left out of the sign", soup.left_out);
  report.sizes.emplace_back("certainty of the orientation", soup.certainty);
  report.warn(
      "orientation-mixed",
      "the orientation of faces disagrees, or faces are double: " + percent_text(soup.turned) +
          " of the area was turned and " + percent_text(soup.left_out) +
          " left out of the sign, by the parity of lines through it, of which " +
          percent_text((1 + soup.certainty) / 2) +
          " agree. Orient faces consistently and leave out double ones to be sure");
  if (soup.certainty < sure) report.status = "uncertain";
}

/// Faces, and the chain they end at.
struct Ended {
  MatX3i faces;
  std::vector<std::array<int, 2>> boundary;
};

/// Faces that cover others exactly add their own part of the solid angle, which moves the patches
/// over holes. They are left out where the surface ends in fewer sides without them; where they
/// belong to parts that are closed with them, they stay.
Ended covered_once(const MatX3& points, const MatX3i& faces, Report& report) {
  Ended out{faces, boundary_chain(points, faces)};
  if (!out.boundary.empty()) {
    Ended once{without_copies(points, faces), {}};
    if (once.faces.rows() < faces.rows()) {
      once.boundary = boundary_chain(points, once.faces);
      if (once.boundary.size() < out.boundary.size()) out = std::move(once);
    }
  }
  if (const auto copies = faces.rows() - out.faces.rows(); copies > 0)
    report.sizes.emplace_back("copies of faces left out of the sign", static_cast<double>(copies));
  out.boundary = each_once(std::move(out.boundary));
  return out;
}

}  // namespace

SettledSides settled_sides(const MatX3& points, const MatX3i& given_faces, bool as_given,
                           const Task& task, Report& report) {
  const Stopwatch watch(report, "sides");
  auto [faces, boundary] = covered_once(points, given_faces, report);
  WindingNumber winding(points, faces);
  const SideCensus census = side_census(points, faces, winding);
  const SideRule rule = choose_sides(census, as_given);
  const SideCensus::Shares given = census.shares(rule);
  // A patch of reversed faces bounds by its own measure, with inside and outside exchanged: it
  // shows by its edges, or by the lines that pass it.
  double against = 0;
  if (given.without > doubtful || !boundary.empty()) {
    const OrientedSoup soup = orient_soup(points, faces, task);
    WindingNumber oriented(points, soup.faces);
    SideCensus::Shares shares = side_census(points, soup.faces, oriented).shares({});
    for (double* share : {&shares.bounds, &shares.within, &shares.without})
      *share *= 1 - soup.left_out;
    shares.without += soup.left_out;
    // Where all normals point inward, those that were not turned are the odd ones.
    const double kept = 1 - soup.turned - soup.left_out;
    against = std::min(soup.turned, kept);
    if (shares.bounds > given.bounds + doubtful ||
        (std::min(soup.surely_turned, kept) > few && shares.bounds > given.bounds - doubtful)) {
      report_orientation(soup, report);
      report_shares(shares, report);
      return {std::move(oriented), as_given ? SideRule{-1, -0.5} : SideRule{}, soup.faces,
              boundary_edges(points, soup.faces), shares.bounds > 0};
    }
  }
  if (against > doubtful) {
    report.status = "uncertain";
    report.warn("sign-uncertain",
                "lines through " + percent_text(against) +
                    " of the area tell another orientation than its faces have, but do not agree: "
                    "signs are uncertain there");
  }
  if (rule.sense < 0)
    report.warn(
        "orientation-reversed",
        "most normals point into the space that the input encloses: all count as reversed, so that "
        "this space is inside");
  report_shares(given, report);
  return {std::move(winding), rule, std::move(faces), std::move(boundary), given.bounds > 0};
}

}  // namespace littoral
