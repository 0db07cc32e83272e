// Samples for learning.

#include "arrays.h"
#include "bindings.h"

namespace littoral::python {

namespace {

VecXi kinds_of(const std::vector<SampleKind>& kinds) {
  VecXi out(static_cast<Eigen::Index>(kinds.size()));
  for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = static_cast<int>(kinds[i]);
  return out;
}

}  // namespace

void bind_samples(nb::module_& m) {
  nb::enum_<SampleNumbers>(m, "SampleNumbers")
      .value("float16", SampleNumbers::float16)
      .value("float32", SampleNumbers::float32)
      .value("float64", SampleNumbers::float64);
  nb::class_<SampleOptions>(m, "SampleOptions")
      .def(nb::init<>())
      .def_rw("resolution", &SampleOptions::resolution)
      .def_rw("surface", &SampleOptions::surface)
      .def_rw("space", &SampleOptions::space)
      .def_rw("sharp", &SampleOptions::sharp)
      .def_rw("uniform", &SampleOptions::uniform)
      .def_rw("curvature", &SampleOptions::curvature)
      .def_rw("scales", &SampleOptions::scales)
      .def_rw("margin", &SampleOptions::margin)
      .def_rw("seed", &SampleOptions::seed)
      .def_rw("numbers", &SampleOptions::numbers);
  nb::class_<Samples>(m, "Samples")
      .def_prop_ro("centre", [](const Samples& s) { return s.centre; })
      .def_ro("half_side", &Samples::half_side)
      .def_prop_ro("surface", [](const Samples& s) { return Mesh(s.surface); })
      .def_prop_ro("surface_points", [](const Samples& s) { return s.surface_points; })
      .def_prop_ro("surface_normals", [](const Samples& s) { return s.surface_normals; })
      .def_prop_ro("surface_confidence", [](const Samples& s) { return s.surface_confidence; })
      .def_prop_ro("surface_kinds", [](const Samples& s) { return kinds_of(s.surface_kinds); })
      .def_prop_ro("points", [](const Samples& s) { return s.points; })
      .def_prop_ro("distances", [](const Samples& s) { return s.distances; })
      .def_prop_ro("confidence", [](const Samples& s) { return s.confidence; })
      .def_prop_ro("kinds", [](const Samples& s) { return kinds_of(s.kinds); })
      .def_prop_ro("deviations", [](const Samples& s) { return s.deviations; })
      .def("card",
           [](const Samples& s, const std::string& input) { return samples_card(s, input); })
      .def("report", [](const Samples& s) { return as_dict(s.report); })
      .def("write", [](const Samples& s, const Path& path, const std::string& input) {
        write(s, path, input);
      });
  m.def(
      "sample",
      [](const Mesh& input, const SampleOptions& options, const std::string& method,
         const OptionValues& method_options, bool flip, bool estimate_normals,
         const Settings* settings) {
        const AnyMethod chosen = AnyMethod::named(method, method_options);
        return released(settings, [&](const Context& context) {
          return sample(input.soup(), options, chosen, {flip, estimate_normals}, context);
        });
      },
      nb::arg("input"), nb::arg("options"), nb::arg("method"), nb::arg("method_options"),
      nb::arg("flip"), nb::arg("estimate_normals"), nb::arg("settings").none());
}

}  // namespace littoral::python
