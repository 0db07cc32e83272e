// Space: signed distance at points and on grids, isosurfaces, offsets, tori.

#include "arrays.h"
#include "bindings.h"

namespace littoral::python {

namespace {

using Triple = std::array<double, 3>;

Grid grid_of(const std::array<int, 3>& n, const Triple& origin, const Triple& spacing) {
  return {n, {origin[0], origin[1], origin[2]}, {spacing[0], spacing[1], spacing[2]}};
}

GridOptions grid_options(std::optional<int> resolution, std::optional<double> spacing,
                         std::optional<std::array<double, 6>> bounds, double padding) {
  return {resolution, spacing, bounds, padding};
}

void bind_volume(nb::module_& m) {
  nb::class_<Grid>(m, "Grid")
      .def(
          "__init__",
          [](Grid* self, const std::array<int, 3>& n, const Triple& origin, const Triple& spacing) {
            new (self) Grid(grid_of(n, origin, spacing));
          },
          nb::arg("n"), nb::arg("origin"), nb::arg("spacing"))
      .def_static(
          "around",
          [](const Sdf& sdf, std::optional<int> resolution, std::optional<double> spacing,
             std::optional<std::array<double, 6>> bounds, double padding) {
            return Grid::around(sdf, grid_options(resolution, spacing, bounds, padding));
          },
          nb::arg("sdf"), nb::arg("resolution").none(), nb::arg("spacing").none(),
          nb::arg("bounds").none(), nb::arg("padding"))
      .def_ro("n", &Grid::n)
      .def_prop_ro("origin", [](const Grid& grid) { return grid.origin; })
      .def_prop_ro("spacing", [](const Grid& grid) { return grid.spacing; });
  nb::class_<Volume>(m, "Volume")
      .def(
          "__init__",
          [](Volume* self, const Grid& grid, Numbers values) {
            new (self) Volume{grid, values, "distance"};
          },
          nb::arg("grid"), nb::arg("values"))
      .def_ro("grid", &Volume::grid)
      .def_prop_ro("values",
                   [](nb::handle self) { return view(nb::cast<const Volume&>(self).values, self); })
      .def("write", [](const Volume& volume, const Path& path) { write(volume, path); })
      .def("write_page", [](const Volume& volume, const Path& path) { write_page(volume, path); })
      .def("write_picture",
           [](const Volume& volume, const Path& path) { write_picture(volume, path); });
  m.def("read_volume", [](const Path& path) { return read_volume(path); });
  m.def(
      "isosurface",
      [](const Volume& volume, double level, bool close_at_box, const Settings* settings) {
        return released(settings, [&](const Context& context) {
          return isosurface(volume, level, close_at_box, context);
        });
      },
      nb::arg("volume"), nb::arg("level"), nb::arg("close_at_box"), nb::arg("settings").none());
  m.def(
      "offset",
      [](const Volume& volume, const std::vector<double>& distances, double open, double close,
         const Settings* settings) {
        return released(settings, [&](const Context& context) {
          return offset(volume, distances, {open, close}, context);
        });
      },
      nb::arg("volume"), nb::arg("distances"), nb::arg("open"), nb::arg("close"),
      nb::arg("settings").none());
  m.def(
      "offset",
      [](const Sdf& shape, const Grid& grid, const std::vector<double>& distances, double open,
         double close, const Settings* settings) {
        return released(settings, [&](const Context& context) {
          return offset(shape, grid, distances, {open, close}, context);
        });
      },
      nb::arg("shape"), nb::arg("grid"), nb::arg("distances"), nb::arg("open"), nb::arg("close"),
      nb::arg("settings").none());
}

void bind_repair(nb::module_& m) {
  m.def(
      "repair",
      [](const Mesh& input, const std::string& method, const OptionValues& values, bool flip,
         bool estimate_normals, std::optional<int> resolution, std::optional<double> spacing,
         double error, double thicken, double smallest_part, bool cavities, bool remesh, bool fit,
         const Settings* settings) {
        RepairOptions options;
        options.grid.resolution = resolution;
        options.grid.spacing = spacing;
        options.error = error;
        options.thicken = thicken;
        options.smallest_part = smallest_part;
        options.cavities = cavities;
        options.remesh = remesh;
        options.fit = fit;
        Repaired out = released(settings, [&](const Context& context) {
          return repair(input.soup(), options, AnyMethod::named(method, values),
                        {flip, estimate_normals}, context);
        });
        return nb::make_tuple(nb::cast(std::move(out.surface)), as_dict(out.report));
      },
      nb::arg("input"), nb::arg("method"), nb::arg("options"), nb::arg("flip"),
      nb::arg("estimate_normals"), nb::arg("resolution").none(), nb::arg("spacing").none(),
      nb::arg("error"), nb::arg("thicken"), nb::arg("smallest_part"), nb::arg("cavities"),
      nb::arg("remesh"), nb::arg("fit"), nb::arg("settings").none());
}

void bind_sdf(nb::module_& m) {
  nb::class_<Sdf>(m, "Sdf")
      .def_static(
          "of",
          [](const Mesh& mesh, const std::string& method, const OptionValues& options,
             const std::vector<double>& values, bool flip, bool estimate_normals,
             const Settings* settings) {
            return released(settings, [&](const Context& context) {
              return signed_distance(mesh.soup(), values, AnyMethod::named(method, options),
                                     {flip, estimate_normals}, context);
            });
          },
          nb::arg("input"), nb::arg("method"), nb::arg("options"), nb::arg("values"),
          nb::arg("flip"), nb::arg("estimate_normals"), nb::arg("settings").none())
      .def_static("of_volume", [](const Volume& volume) { return signed_distance(volume); })
      .def(
          "at",
          [](const Sdf& self, Points x, const Settings* settings) {
            return released(settings, [&](const Context& context) { return self.at(x, context); });
          },
          nb::arg("points"), nb::arg("settings").none())
      .def(
          "with_gradients",
          [](const Sdf& self, Points x, const Settings* settings) {
            DistanceSamples out = released(
                settings, [&](const Context& context) { return self.with_gradients(x, context); });
            return nb::make_tuple(nb::cast(std::move(out.values)),
                                  nb::cast(std::move(out.gradients)));
          },
          nb::arg("points"), nb::arg("settings").none())
      .def(
          "closest",
          [](const Sdf& self, Points x, const Settings* settings) {
            NearestPoints out = released(
                settings, [&](const Context& context) { return self.closest(x, context); });
            return nb::make_tuple(
                nb::cast(std::move(out.points)), nb::cast(std::move(out.elements)),
                nb::cast(std::move(out.corners)), nb::cast(std::move(out.barycentric)),
                nb::cast(std::move(out.distances)));
          },
          nb::arg("points"), nb::arg("settings").none())
      .def(
          "winding_number",
          [](const Sdf& self, Points x, const Settings* settings) {
            return released(
                settings, [&](const Context& context) { return self.winding_number(x, context); });
          },
          nb::arg("points"), nb::arg("settings").none())
      .def(
          "confidence",
          [](const Sdf& self, Points x, const Settings* settings) {
            return released(settings,
                            [&](const Context& context) { return self.confidence(x, context); });
          },
          nb::arg("points"), nb::arg("settings").none())
      .def(
          "sample",
          [](const Sdf& self, const Grid& grid, const Settings* settings) {
            return released(settings,
                            [&](const Context& context) { return self.sample(grid, context); });
          },
          nb::arg("grid"), nb::arg("settings").none())
      .def("bounds",
           [](const Sdf& self) {
             const MatX3 corners = self.bounds();
             return corners;
           })
      .def("report", [](const Sdf& self) { return as_dict(self.report()); });
  m.def("unite", unite, nb::arg("a"), nb::arg("b"), nb::arg("blend"));
  m.def("intersect", intersect, nb::arg("a"), nb::arg("b"), nb::arg("blend"));
  m.def("subtract", subtract, nb::arg("a"), nb::arg("b"), nb::arg("blend"));
  m.def(
      "fit_tori",
      [](const Mesh& cloud, const OptionValues& values, bool flip, bool estimate_normals,
         const Settings* settings) {
        return as_tuple(released(settings, [&](const Context& context) {
          return fit_tori(cloud.soup(), AnyMethod::named(Tori::method, values),
                          {flip, estimate_normals}, context);
        }));
      },
      nb::arg("cloud"), nb::arg("options"), nb::arg("flip"), nb::arg("estimate_normals"),
      nb::arg("settings").none());
}

}  // namespace

void bind_space(nb::module_& m) {
  bind_volume(m);
  bind_sdf(m);
  bind_repair(m);
}

}  // namespace littoral::python
