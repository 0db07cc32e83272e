// Surfaces: meshes, sources, distance, all pairs, regions.

#include "api/surface/surface_domain.h"
#include "arrays.h"
#include "bindings.h"

namespace littoral::python {

namespace {

Mesh mesh_of(Points points, Corners faces) {
  PolygonSoup soup;
  soup.points = points;
  soup.corners.assign(faces.data(), faces.data() + faces.size());
  soup.face_offsets.resize(static_cast<std::size_t>(faces.rows()) + 1);
  for (std::size_t f = 0; f < soup.face_offsets.size(); ++f)
    soup.face_offsets[f] = static_cast<int>(f * static_cast<std::size_t>(faces.cols()));
  return Mesh(std::move(soup));
}

Mesh polygons(Points points, Integers corners, Integers offsets) {
  PolygonSoup soup;
  soup.points = points;
  soup.corners.assign(corners.begin(), corners.end());
  soup.face_offsets.assign(offsets.begin(), offsets.end());
  return Mesh(std::move(soup));
}

Mesh voxels(const Grid& grid, nb::ndarray<const unsigned char, nb::ndim<1>, nb::c_contig> inside) {
  return Mesh::voxels(grid, {inside.data(), inside.data() + inside.size()});
}

/// Its soup, and of the boundary of voxels also the normals, which do not come from that.
nb::tuple mesh_state(const Mesh& mesh) {
  const nb::tuple soup = as_tuple(mesh.soup());
  const auto& normals = mesh.domain().face_normals;
  return normals ? nb::tuple(soup + nb::make_tuple(nb::cast(MatX3(*normals)))) : soup;
}

Mesh mesh_from(const nb::tuple& state) {
  constexpr std::size_t of_soup = 6;
  Mesh mesh(as_soup(state));
  if (state.size() == of_soup) return mesh;
  auto normals = std::make_shared<const MatX3>(nb::cast<MatX3>(state[of_soup]));
  if (normals->rows() != mesh.n_faces()) throw InputError("voxels have a normal for each face");
  return Mesh(SurfaceDomain{mesh.domain().mesh, std::move(normals)});
}

void bind_mesh(nb::module_& m) {
  nb::class_<Mesh>(m, "Mesh")
      .def_static("of", mesh_of, nb::arg("points"), nb::arg("faces"))
      .def_static("polygons", polygons, nb::arg("points"), nb::arg("corners"), nb::arg("offsets"))
      .def_static(
          "cloud", [](Points points, Points normals) { return Mesh::cloud(points, normals); },
          nb::arg("points"), nb::arg("normals"))
      .def_static("voxels", voxels, nb::arg("grid"), nb::arg("inside"))
      .def_static("from_soup", mesh_from, nb::arg("soup"))
      .def("soup", mesh_state)
      .def_prop_ro("kind", &Mesh::kind)
      .def_prop_ro("n_vertices", &Mesh::n_vertices)
      .def_prop_ro("n_faces", &Mesh::n_faces)
      .def_prop_ro("n_edges", &Mesh::n_edges)
      .def_prop_ro("n_components", &Mesh::n_components)
      .def_prop_ro("points",
                   [](nb::handle self) { return view(nb::cast<const Mesh&>(self).points(), self); })
      .def_prop_ro(
          "normals",
          [](nb::handle self) { return view(nb::cast<const Mesh&>(self).soup().normals, self); })
      .def_prop_ro(
          "corners",
          [](nb::handle self) { return view(nb::cast<const Mesh&>(self).soup().corners, self); })
      .def_prop_ro("face_offsets",
                   [](nb::handle self) {
                     return view(nb::cast<const Mesh&>(self).soup().face_offsets, self);
                   })
      .def("edges", [](const Mesh& mesh) { return mesh.edges(); })
      .def(
          "welded", [](const Mesh& mesh, double distance) { return mesh.welded(distance); },
          nb::arg("distance"), nb::call_guard<nb::gil_scoped_release>())
      .def("positions",
           [](const Mesh& mesh, const PointArrays& at) {
             MatX3 out(std::ssize(at.points), 3);
             for (Eigen::Index i = 0; i < out.rows(); ++i) out.row(i) = mesh.position(at.points[i]);
             return out;
           })
      .def("interpolate",
           [](const Mesh& mesh, Numbers values, const PointArrays& at) {
             const VecX given = values;
             VecX out(std::ssize(at.points));
             for (Eigen::Index i = 0; i < out.size(); ++i)
               out[i] = mesh.interpolate(given, at.points[i]);
             return out;
           })
      .def("write", [](const Mesh& mesh, const Path& path) { write(mesh, path); });
  m.def("mesh_extensions", mesh_extensions);
  m.def("read_mesh", [](const Path& path) {
    const nb::gil_scoped_release unlocked;
    return read_mesh(path);
  });
}

void bind_sources(nb::module_& m) {
  nb::class_<PointArrays>(m, "Points")
      .def(
          "__init__",
          [](PointArrays* self, Integers on, Integers element, Points b) {
            new (self) PointArrays;
            for (Eigen::Index i = 0; i < on.size(); ++i)
              self->points.push_back(
                  {static_cast<SurfacePoint::On>(on[i]), element[i], {b(i, 0), b(i, 1), b(i, 2)}});
          },
          nb::arg("on"), nb::arg("element"), nb::arg("b"))
      .def("__len__", [](const PointArrays& self) { return self.points.size(); })
      .def("arrays", [](const PointArrays& self) {
        const Eigen::Index n = std::ssize(self.points);
        VecXi on(n), element(n);
        MatX3 b(n, 3);
        for (Eigen::Index i = 0; i < n; ++i) {
          const SurfacePoint& p = self.points[i];
          on[i] = static_cast<int>(p.on);
          element[i] = p.element;
          b.row(i) << p.b[0], p.b[1], p.b[2];
        }
        return nb::make_tuple(on, element, b);
      });
  nb::class_<Sources>(m, "Sources")
      .def(nb::init<>())
      .def("add_curve",
           [](Sources& self, const PointArrays& nodes, bool is_signed, double value) {
             self.add(Curve{nodes.points, is_signed, {}, value});
           })
      .def("add_points",
           [](Sources& self, const PointArrays& points, Numbers values) {
             for (std::size_t i = 0; i < points.points.size(); ++i)
               self.add(points.points[i], values[static_cast<Eigen::Index>(i)]);
           })
      .def("add_space_curve",
           [](Sources& self, Points points, bool is_signed, double value) {
             self.add(SpaceCurve{points, is_signed, {}, value});
           })
      .def("add_chain",
           [](Sources& self, Integers faces) {
             self.add(FaceChain{{faces.begin(), faces.end()}, {}});
           })
      .def("reversed", &Sources::reversed)
      .def("sizes",
           [](const Sources& self) {
             return nb::make_tuple(self.curves.size(), self.points.size(), self.space_curves.size(),
                                   self.chains.size());
           })
      .def("curve",
           [](const Sources& self, std::size_t i) {
             const Curve& curve = self.curves.at(i);
             return std::tuple(PointArrays{curve.nodes}, curve.is_signed, curve.value);
           })
      .def("space_curve",
           [](const Sources& self, std::size_t i) {
             const SpaceCurve& curve = self.space_curves.at(i);
             return std::tuple(curve.points, curve.is_signed, curve.value);
           })
      .def("chain", [](const Sources& self, std::size_t i) { return self.chains.at(i).faces; })
      .def("points", [](const Sources& self) { return PointArrays{self.points}; })
      .def("point_values", [](const Sources& self) {
        VecX values(std::ssize(self.points));
        for (Eigen::Index i = 0; i < values.size(); ++i)
          values[i] = self.point_value(static_cast<std::size_t>(i));
        return values;
      });
  m.def("read_sources",
        [](const Path& path, const Mesh& mesh) { return read_sources(path, mesh); });
}

std::vector<MatX3> isolines(const Mesh& mesh, Numbers values, double level) {
  return Field{mesh, {}, values, {}, {}, {}}.isolines(level);
}

/// A field from what a pickle holds.
Field field_of(const Mesh& mesh, const Sources& sources, Numbers values, Numbers confidence,
               const std::optional<nb::tuple>& refined, const nb::dict& report) {
  std::optional<PolygonSoup> shown;
  if (refined) shown = as_soup(*refined);
  return {mesh, sources, values, std::move(shown), as_report(report), confidence};
}

void bind_distance(nb::module_& m) {
  nb::class_<Field>(m, "Field")
      .def_static("of", field_of, nb::arg("mesh"), nb::arg("sources"), nb::arg("values"),
                  nb::arg("confidence"), nb::arg("refined").none(), nb::arg("report"))
      .def_prop_ro("values",
                   [](nb::handle self) { return view(nb::cast<const Field&>(self).values, self); })
      .def_prop_ro(
          "confidence",
          [](nb::handle self) { return view(nb::cast<const Field&>(self).confidence, self); })
      .def_prop_ro("sources", [](const Field& field) { return field.sources; })
      .def("refined",
           [](const Field& field) -> std::optional<nb::tuple> {
             if (!field.refined) return {};
             return as_tuple(*field.refined);
           })
      .def("report", [](const Field& field) { return as_dict(field.report); })
      .def("write", [](const Field& field, const Path& path) { write(field, path); })
      .def("write_page", [](const Field& field, const Path& path) { write_page(field, path); })
      .def("write_picture",
           [](const Field& field, const Path& path) { write_picture(field, path); });
  m.def("isolines", isolines);
  m.def(
      "distance",
      [](const Mesh& mesh, const Sources& sources, const std::string& method,
         const OptionValues& values, const Settings* settings) {
        return released(settings, [&](const Context& context) {
          return distance(mesh, sources, AnyMethod::named(method, values), context);
        });
      },
      nb::arg("mesh"), nb::arg("sources"), nb::arg("method"), nb::arg("options"),
      nb::arg("settings").none());
  nb::class_<DistanceSolver>(m, "DistanceSolver")
      .def(
          "__init__",
          [](DistanceSolver* self, const Mesh& mesh, const std::string& method,
             const OptionValues& values, const Settings* settings) {
            new (self) DistanceSolver(released(settings, [&](const Context& context) {
              return DistanceSolver(mesh, AnyMethod::named(method, values), context);
            }));
          },
          nb::arg("mesh"), nb::arg("method"), nb::arg("options"), nb::arg("settings").none())
      .def(
          "solve",
          [](const DistanceSolver& self, const Sources& sources, const Settings* settings) {
            return released(settings,
                            [&](const Context& context) { return self.solve(sources, context); });
          },
          nb::arg("sources"), nb::arg("settings").none())
      .def("report", [](const DistanceSolver& self) { return as_dict(self.report()); });
  m.def(
      "distance_matrix",
      [](const Mesh& mesh, const PointArrays& from, const PointArrays* to,
         const std::string& method, const OptionValues& values, const Settings* settings) {
        DistanceMatrix out = released(settings, [&](const Context& context) {
          const AnyMethod chosen = AnyMethod::named(method, values);
          return to ? distance_matrix(mesh, from.points, to->points, chosen, context)
                    : distance_matrix(mesh, from.points, chosen, context);
        });
        return nb::make_tuple(nb::cast(std::move(out.values)), as_dict(out.report));
      },
      nb::arg("mesh"), nb::arg("sources"), nb::arg("targets").none(), nb::arg("method"),
      nb::arg("options"), nb::arg("settings").none());
}

void bind_winding(nb::module_& m) {
  nb::class_<Regions>(m, "Regions")
      .def_static("of",
                  [](const Mesh& mesh, Integers region, const nb::tuple& surface,
                     std::vector<MatX3> bounding, std::vector<MatX3> nonbounding,
                     std::vector<MatX3> completed, const Sources& sources, const nb::dict& report) {
                    return Regions{mesh,
                                   region,
                                   as_soup(surface),
                                   std::move(bounding),
                                   std::move(nonbounding),
                                   std::move(completed),
                                   sources,
                                   as_report(report)};
                  })
      .def_prop_ro(
          "region",
          [](nb::handle self) { return view(nb::cast<const Regions&>(self).region, self); })
      .def("surface", [](const Regions& regions) { return as_tuple(regions.surface); })
      .def_ro("bounding", &Regions::bounding)
      .def_ro("nonbounding", &Regions::nonbounding)
      .def_ro("completed", &Regions::completed)
      .def_prop_ro("bounding_sources",
                   [](const Regions& regions) { return regions.bounding_sources; })
      .def("report", [](const Regions& regions) { return as_dict(regions.report); })
      .def("write", [](const Regions& regions, const Path& path) { write(regions, path); })
      .def("write_page",
           [](const Regions& regions, const Path& path) { write_page(regions, path); })
      .def("write_picture",
           [](const Regions& regions, const Path& path) { write_picture(regions, path); });
  m.def(
      "winding",
      [](const Mesh& mesh, const Sources& curves, const std::string& method,
         const OptionValues& values, const Settings* settings) {
        return released(settings, [&](const Context& context) {
          return winding(mesh, curves, AnyMethod::named(method, values), context);
        });
      },
      nb::arg("mesh"), nb::arg("curves"), nb::arg("method"), nb::arg("options"),
      nb::arg("settings").none());
}

}  // namespace

void bind_surfaces(nb::module_& m) {
  bind_mesh(m);
  bind_sources(m);
  bind_distance(m);
  bind_winding(m);
}

}  // namespace littoral::python
