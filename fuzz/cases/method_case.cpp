#include "method_case.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "api/space/space_domain.h"
#include "api/surface/pairs.h"
#include "api/surface/surface_domain.h"
#include "api/surface/winding.h"
#include "api/tet/tet_domain.h"
#include "case_checks.h"
#include "domains.h"
#include "littoral/error.h"
#include "littoral/mesh.h"

namespace littoral::fuzz {

namespace {

/// A value of one option: an end of its range, one inside, its default, or nonsense.
std::string random_value(Choices& choose, const OptionInfo& info) {
  if (choose.chance(0.02)) return "nonsense";
  switch (info.kind) {
    case OptionInfo::Kind::toggle:
      return choose.chance(0.5) ? "on" : "off";
    case OptionInfo::Kind::choice:
      return choose.pick(info.choices);
    case OptionInfo::Kind::text:
      return "no such file";
    default:
      break;
  }
  const bool whole = info.kind == OptionInfo::Kind::integer;
  // Large numbers of iterations or pieces are slow, as they say.
  const double high = whole ? std::min(info.high, 200.0) : info.high;
  const double low = std::min(info.low, high);
  std::ostringstream out;
  out.precision(17);
  double value = choose.chance(0.1) ? low : choose.chance(0.1) ? high : 0;
  if (value == 0 && low >= 0 && high > 0) {
    const double from = std::log(std::max(low, 1e-9 * high)), to = std::log(high);
    value = std::exp(from + choose.unit() * (to - from));
  } else if (value == 0) {
    value = low + choose.unit() * (high - low);
  }
  if (choose.chance(0.01)) value = 2 * info.high + 1;
  if (whole && info.name == "subdivide") value = std::min(value, 8.0);
  out << (whole ? std::floor(std::clamp(value, -1e9, 1e9)) : value);
  return out.str();
}

PolygonSoup surface_for(Choices& choose, const MethodInfo& info) {
  std::string kind = choose.pick(info.domains);
  if (choose.chance(0.03)) kind = "point cloud";
  PolygonSoup soup = kind == "polygon mesh"  ? random_polygons(choose)
                     : kind == "point cloud" ? random_cloud(choose)
                                             : random_triangles(choose);
  const double scale = std::exp2(choose.chance(0.2) ? choose.between(-100, 100) : 0);
  soup.points *= choose.chance(0.02) ? 1e160 : scale;
  return soup;
}

}  // namespace

MethodCase random_case(Choices& choose) {
  MethodCase out;
  const std::vector<MethodFamily> families = method_families();
  // Surfaces have most methods, and most ways to be broken.
  const int which = choose.chance(0.5) ? 0 : choose.below(static_cast<int>(families.size()));
  const MethodFamily& family = families[which];
  const MethodInfo& info = choose.pick(family.methods);
  out.family = family.title;
  out.method = info.name;
  for (const OptionInfo& option : info.options)
    if (choose.chance(0.25)) out.options.emplace_back(option.name, random_value(choose, option));
  if (choose.chance(0.01)) out.options.emplace_back("nonsense", "1");
  if (family.title == TetDomain::title) {
    out.tets = random_tets(choose);
    out.tet_sources = random_tet_sources(choose, out.tets);
    return out;
  }
  if (family.title == SpaceDomain::title) {
    out.soup = choose.chance(0.6) ? random_triangles(choose) : random_cloud(choose);
    for (int k = 0; k < 3; ++k) out.grid.n[k] = choose.between(choose.chance(0.1) ? 1 : 2, 7);
    out.grid.origin = Vec3::Constant(-1.5);
    out.grid.spacing = Vec3::Constant(0.4 + choose.unit());
    if (choose.chance(0.25)) {
      int n = out.soup.n_faces() > 0 ? out.soup.n_faces() : out.soup.n_vertices();
      if (choose.chance(0.3)) n = choose.below(3);
      for (int i = 0; i < n; ++i) out.space_values.push_back(0.4 * (choose.below(3) - 1));
      if (choose.chance(0.3)) out.soup.normals.resize(0, 3);
    }
    return out;
  }
  out.soup = surface_for(choose, info);
  int n_edges = 0;
  try {
    n_edges = Mesh(out.soup).n_edges();
  } catch (const InputError&) {  // found again, and then checked, by the call itself
  }
  out.sources = random_sources(choose, out.soup, n_edges);
  return out;
}

Outcome run_case(const MethodCase& given, Choices& choose, double seconds) {
  Outcome out;
  const auto fail = [&](const std::string& what) {
    out.kind = Outcome::Kind::failed;
    out.failures.push_back(what);
  };
  try {
    for (const std::string& what : checked(given, choose, seconds)) fail(what);
  } catch (const Cancelled&) {
    fail("took longer than its budget");
  } catch (const SolveError& error) {
    out.kind = Outcome::Kind::broke_down;
    out.error = error.what();
  } catch (const Error& error) {
    out.kind = Outcome::Kind::refused;
    out.error = error.what();
    if (out.error.size() < 8) fail("an error that says nothing: " + out.error);
  } catch (const std::exception& error) {
    fail(std::string("an error that is not the library's: ") + error.what());
  }
  return out;
}

namespace {

void print(std::ostream& out, const PolygonSoup& soup) {
  for (Eigen::Index v = 0; v < soup.points.rows(); ++v) {
    out << "v " << soup.points.row(v) << "\n";
    if (soup.normals.rows() > 0) out << "vn " << soup.normals.row(v) << "\n";
  }
  for (int f = 0; f < soup.n_faces(); ++f) {
    out << "f";
    for (const int v : soup.face(f)) out << " " << v + 1;
    out << "\n";
  }
}

void print(std::ostream& out, const SurfacePoint& p) {
  out << "vef"[static_cast<int>(p.on)] << p.element;
  if (p.on != SurfacePoint::On::vertex)
    out << "(" << p.b[0] << " " << p.b[1] << " " << p.b[2] << ")";
  out << " ";
}

}  // namespace

std::string description(const MethodCase& given) {
  std::ostringstream out;
  out.precision(17);
  out << given.family << ": " << given.method;
  for (const auto& [name, value] : given.options) out << " --" << name << " " << value;
  out << "\n";
  print(out, given.soup);
  for (const SurfacePoint& p : given.sources.points) print(out << "# point ", p);
  for (const Curve& curve : given.sources.curves) {
    out << "\n# " << (curve.is_signed ? "signed" : "unsigned") << " curve ";
    for (const SurfacePoint& p : curve.nodes) print(out, p);
  }
  for (const SpaceCurve& curve : given.sources.space_curves)
    out << "\n# curve in space\n" << curve.points;
  if (given.tets.n_tets() > 0) {
    out << "# tets\n"
        << given.tets.points << "\n"
        << given.tets.tets << "\n# sources" << (given.tet_sources.boundary ? " boundary" : "")
        << (given.tet_sources.flip ? " flip" : "")
        << (given.tet_sources.estimate_normals ? " estimate-normals" : "");
    for (const int v : given.tet_sources.vertices) out << " " << v;
    for (const double value : given.tet_sources.values) out << " value " << value;
    out << "\n";
    print(out, given.tet_sources.surface);
  }
  for (const double value : given.space_values) out << "# value " << value << "\n";
  if (given.grid.n[0] > 0)
    out << "# grid " << given.grid.n[0] << " " << given.grid.n[1] << " " << given.grid.n[2]
        << " by " << given.grid.spacing[0];
  return out.str();
}

}  // namespace littoral::fuzz
