// The methods that come with the library: one line for each family.

#include <initializer_list>
#include <iterator>

#include "api/space/space_domain.h"
#include "api/surface/pairs.h"
#include "api/surface/surface_domain.h"
#include "api/surface/winding.h"
#include "api/tet/tet_domain.h"

namespace littoral {

namespace {

/// The entries of families, one after the other.
template <class D>
std::vector<Method<D>> all_of(std::initializer_list<std::vector<Method<D>> (*)()> families) {
  std::vector<Method<D>> out;
  for (const auto family : families) {
    std::vector<Method<D>> entries = family();
    std::move(entries.begin(), entries.end(), std::back_inserter(out));
  }
  return out;
}

template <class... Ds>
std::vector<MethodFamily> families() {
  return {{Ds::title, Registry<Ds>::instance().infos()}...};
}

}  // namespace

template <>
std::vector<Method<SurfaceDomain>> library_methods() {
  return all_of<SurfaceDomain>(
      {automatic_methods, heat_methods, geodesic_methods, quadratic_methods, regularized_methods});
}

template <>
std::vector<Method<TetDomain>> library_methods() {
  return all_of<TetDomain>(
      {automatic_tet_methods, heat_tet_methods, regularized_tet_methods, quadratic_tet_methods});
}

template <>
std::vector<Method<SpaceDomain>> library_methods() {
  return all_of<SpaceDomain>({automatic_space_methods, space_heat_methods, closest_point_methods,
                              convolutional_methods, tori_methods, regularized_space_methods});
}

std::vector<MethodFamily> method_families() {
  return families<SurfaceDomain, PairsDomain, WindingDomain, TetDomain, SpaceDomain>();
}

}  // namespace littoral
