// Distance through tets.

#include "arrays.h"
#include "bindings.h"

namespace littoral::python {

static std::optional<Section> cut(int axis, std::optional<double> position) {
  if (!position) return {};
  return Section{axis, *position};
}

void bind_tets(nb::module_& m) {
  nb::class_<TetMesh>(m, "TetMesh")
      .def(
          "__init__",
          [](TetMesh* self, Points points, Eigen::Map<const Rows<int, 4>> tets) {
            new (self) TetMesh{points, tets};
          },
          nb::arg("points"), nb::arg("tets"))
      .def_prop_ro(
          "points",
          [](nb::handle self) { return view(nb::cast<const TetMesh&>(self).points, self); })
      .def_prop_ro("tets",
                   [](nb::handle self) { return view(nb::cast<const TetMesh&>(self).tets, self); })
      .def(
          "isosurface",
          [](const TetMesh& mesh, Numbers values, double level, const Settings* settings) {
            const TetField field{mesh, values, {}};
            return released(settings, [&](const Context& context) {
              return isosurface(field, level, context);
            });
          },
          nb::arg("values"), nb::arg("level"), nb::arg("settings").none());
  nb::class_<TetSources>(m, "TetSources")
      .def(
          "__init__",
          [](TetSources* self, const Mesh* surface, const std::vector<int>& vertices, bool boundary,
             bool flip, bool estimate_normals, const std::vector<double>& values) {
            new (self) TetSources{surface ? surface->soup() : PolygonSoup{},
                                  vertices,
                                  boundary,
                                  flip,
                                  estimate_normals,
                                  values};
          },
          nb::arg("surface").none(), nb::arg("vertices"), nb::arg("boundary"), nb::arg("flip"),
          nb::arg("estimate_normals"), nb::arg("values"));
  nb::class_<TetField>(m, "TetField")
      .def_static(
          "of",
          [](const TetMesh& mesh, Numbers values, const nb::dict& report) {
            return TetField{mesh, values, as_report(report)};
          },
          nb::arg("mesh"), nb::arg("values"), nb::arg("report"))
      .def_prop_ro(
          "values",
          [](nb::handle self) { return view(nb::cast<const TetField&>(self).values, self); })
      .def("report", [](const TetField& field) { return as_dict(field.report); })
      .def("write", [](const TetField& field, const Path& path) { write(field, path); })
      .def(
          "write_page",
          [](const TetField& field, const Path& path, int axis, std::optional<double> position) {
            write_page(field, path, cut(axis, position));
          },
          nb::arg("path"), nb::arg("axis"), nb::arg("position").none())
      .def(
          "write_picture",
          [](const TetField& field, const Path& path, int axis, std::optional<double> position) {
            write_picture(field, path, cut(axis, position));
          },
          nb::arg("path"), nb::arg("axis"), nb::arg("position").none());
  nb::class_<TetDistanceSolver>(m, "TetDistanceSolver")
      .def(
          "__init__",
          [](TetDistanceSolver* self, const TetMesh& mesh, const std::string& method,
             const OptionValues& values, const Settings* settings) {
            new (self) TetDistanceSolver(released(settings, [&](const Context& context) {
              return TetDistanceSolver(mesh, AnyMethod::named(method, values), context);
            }));
          },
          nb::arg("mesh"), nb::arg("method"), nb::arg("options"), nb::arg("settings").none())
      .def(
          "solve",
          [](const TetDistanceSolver& self, const TetSources& sources, const Settings* settings) {
            return released(settings,
                            [&](const Context& context) { return self.solve(sources, context); });
          },
          nb::arg("sources"), nb::arg("settings").none());
  m.def(
      "tets_around",
      [](const Mesh& surface, std::optional<int> resolution, std::optional<double> spacing,
         std::optional<std::array<double, 6>> bounds, double padding, const Settings* settings) {
        return released(settings, [&](const Context& context) {
          return tets_around(surface.soup(), {resolution, spacing, bounds, padding}, context);
        });
      },
      nb::arg("surface"), nb::arg("resolution").none(), nb::arg("spacing").none(),
      nb::arg("bounds").none(), nb::arg("padding"), nb::arg("settings").none());
  m.def("read_tets", [](const Path& path) { return read_tets(path); });
}

}  // namespace littoral::python
