#pragma once
// Any method of the library on a small random domain, from random sources, with random options; and
// what must be so whatever comes out.

#include <string>
#include <vector>

#include "choices.h"
#include "littoral/methods.h"
#include "littoral/polygon_soup.h"
#include "littoral/sources.h"
#include "littoral/tet_mesh.h"
#include "littoral/tet_sources.h"
#include "littoral/volume.h"

namespace littoral::fuzz {

/// One call. Of the domains that which the family is about.
struct MethodCase {
  std::string family;  // MethodFamily::title
  std::string method;
  OptionValues options;
  PolygonSoup soup;
  Sources sources;
  TetMesh tets;
  TetSources tet_sources;
  Grid grid;
  std::vector<double> space_values;  // of the soup's faces or points

  AnyMethod choice() const { return AnyMethod::named(method, options); }
};

struct Outcome {
  enum class Kind { answered, refused, broke_down, failed };
  Kind kind = Kind::answered;         // refused: by an error that names the input; broke_down: by
                                      // one that says a solve did
  std::string error;                  // its text
  std::vector<std::string> failures;  // of what must be so; kind is then `failed`
};

/// A method, any that is registered; a domain it runs on, seldom another; sources; options within
/// their ranges, seldom outside.
MethodCase random_case(Choices& choose);

/// Calls, and checks. No call may take more than `seconds` of processor time, or more checkpoints
/// than any finite loop over so small a domain needs.
Outcome run_case(const MethodCase& given, Choices& choose, double seconds);

/// The case in words and numbers, enough to repeat it by hand.
std::string description(const MethodCase& given);

}  // namespace littoral::fuzz
