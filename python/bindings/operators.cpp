// The matrices of a surface, and their factorizations.

#include "arrays.h"
#include "bindings.h"

namespace littoral::python {

void bind_operators(nb::module_& m) {
  nb::class_<SurfaceOperators>(m, "SurfaceOperators")
      .def_ro("L", &SurfaceOperators::L)
      .def_ro("M", &SurfaceOperators::M)
      .def_ro("G", &SurfaceOperators::G)
      .def_ro("A", &SurfaceOperators::A)
      .def_ro("D", &SurfaceOperators::D)
      .def_ro("connection", &SurfaceOperators::connection)
      .def_ro("connection_mass", &SurfaceOperators::connection_mass)
      .def_ro("vector_at", &SurfaceOperators::vector_at);
  m.def(
      "surface_operators",
      [](const Mesh& mesh, const Settings* settings) {
        return released(settings,
                        [&](const Context& context) { return surface_operators(mesh, context); });
      },
      nb::arg("mesh"), nb::arg("settings").none());
  nb::class_<Factorization>(m, "Factorization")
      .def_static(
          "real",
          [](const SpMat& A, bool laplacian, const Settings* settings) {
            return released(settings, [&](const Context& context) {
              return Factorization(A, laplacian ? Definite::laplacian : Definite::yes, context);
            });
          },
          nb::arg("A"), nb::arg("laplacian"), nb::arg("settings").none())
      .def_static(
          "complex",
          [](const SpMatC& A, const Settings* settings) {
            return released(settings,
                            [&](const Context& context) { return Factorization(A, context); });
          },
          nb::arg("A"), nb::arg("settings").none())
      .def(
          "solve",
          [](const Factorization& self, const MatX& B, const Settings* settings) {
            return released(settings,
                            [&](const Context& context) { return self.solve(B, context); });
          },
          nb::arg("B"), nb::arg("settings").none())
      .def(
          "solve_complex",
          [](const Factorization& self, const Eigen::MatrixXcd& B, const Settings* settings) {
            return released(settings,
                            [&](const Context& context) { return self.solve(B, context); });
          },
          nb::arg("B"), nb::arg("settings").none())
      .def_prop_ro("size", &Factorization::size)
      .def_prop_ro("nonzeros", &Factorization::nonzeros);
}

}  // namespace littoral::python
