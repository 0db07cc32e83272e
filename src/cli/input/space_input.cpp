#include "cli/input/space_input.h"

#include <algorithm>
#include <numeric>

#include "api/space/input_queries.h"
#include "api/space/volume_meaning.h"
#include "api/tet/tet_boundary.h"
#include "base/counted.h"
#include "base/option_table.h"
#include "cli/input/numbers.h"
#include "io/formats.h"
#include "io/read.h"
#include "io/write.h"
#include "littoral/error.h"
#include "sources/space/parts_of_samples.h"

namespace littoral::cli {

void add_space_input(CLI::App& verb, SpaceArguments& texts, Session& session,
                     const io::Kinds& kinds) {
  add_input_option(verb, "INPUT", texts.input, kinds_help(kinds));
  verb.add_flag("--estimate-normals", texts.estimate_normals,
                "of a point cloud: compute normals from neighbouring points");
  verb.add_flag("--flip", session.flip, "reverse all normals: the other side is positive");
}

void add_space_method(CLI::App& verb, SpaceArguments& texts, const std::string& domain) {
  std::vector<MethodInfo> methods = Registry<SpaceDomain>::instance().infos();
  std::erase_if(methods, [&](const MethodInfo& method) {
    return std::find(method.domains.begin(), method.domains.end(), domain) == method.domains.end();
  });
  add_methods(verb, texts.method, methods);
}

namespace {

void add_meaning_options(CLI::App& verb, SpaceArguments& texts) {
  const auto group = in_group("Volumes as input");
  group(verb.add_option("--as", texts.meaning,
                        "what volumes hold: mask (0 outside, all else inside; with --flip 0 "
                        "inside), distance (negative "
                        "inside, taken as it is) or density (larger than --threshold inside) "
                        "[default: voxels and volumes of 0 and one other value are masks; those of "
                        "both signs and slope 1 distance; all else is an error]"))
      ->check(one_of({"auto", "distance", "mask", "density"}))
      ->type_name("WORD");
  group(verb.add_option("--threshold", texts.threshold,
                        "of --as density: where the surface is [default: half way between the "
                        "smallest and the largest value]"))
      ->type_name("T");
  group(verb.add_flag("--redistance", texts.redistance,
                      "INPUT is a volume of any values: distance to where they are zero, negative "
                      "where they are"));
}

}  // namespace

void add_shape_options(CLI::App& verb, SpaceArguments& texts, bool with_offset) {
  const auto group = in_group("Several shapes");
  const std::string kinds = ": mesh, soup, cloud, or volume of distance; may be repeated";
  for (const auto& [name, files, what] :
       {std::tuple("--unite", &texts.unite, "also this shape"),
        {"--intersect", &texts.intersect, "only what lies within this shape"},
        {"--subtract", &texts.subtract, "without this shape"}})
    group(add_repeated_option(verb, name, *files, what + kinds))->type_name("FILE");
  group(verb.add_option("--operand-method", texts.operand_method,
                        "of the shapes after INPUT [default: as --method where that is given, "
                        "otherwise auto]"))
      ->type_name("NAME");
  const std::string unit = std::string(" [") + length_unit_text + "; default 0]";
  group(verb.add_option("--blend", texts.blend,
                        "round corners where shapes meet, this far from them" + unit))
      ->type_name("R");
  if (with_offset)
    group(verb.add_option("--offset", texts.offset,
                          "move the surface outward, or if negative inward" + unit))
        ->type_name("D");
  add_meaning_options(verb, texts);
}

void add_values_option(CLI::App& verb, SpaceArguments& texts) {
  verb.add_option("--values", texts.values,
                  std::string("what distance is counted from: one for all of INPUT, one for each "
                              "connected part of a surface, in the order of their first faces, or "
                              "one for each point of a cloud [") +
                      length_unit_text +
                      "]; or the name of the field of a cloud that holds them. Of points without "
                      "normals the least of value plus distance: balls where values are negative")
      ->type_name("C,...");
}

void add_confidence_option(CLI::App& verb, bool& confidence) {
  verb.add_flag("--confidence", confidence,
                "also how sure inside and outside are, 0 to 1, by the winding number of INPUT");
}

VecX confidence_at(const CsgShapes& shapes, const MatX3& points, Session& session) {
  const Shape& input = shapes.all.front();
  if (!shapes.plain() || input.field)
    throw InputError("option confidence is for one mesh, soup or cloud", "options-conflict");
  Report ignored;  // the distance's holds the same
  const Task task = session.task();
  const WindingOfInput winding(input.surface, {input.request.flip, input.request.estimate_normals},
                               task, ignored);
  return winding.confidence(points, task);
}

void add_grid_options(CLI::App& verb, SpaceArguments& texts, const GridOptions& defaults) {
  texts.padding = defaults.padding;
  verb.add_option("--resolution", texts.resolution,
                  "nodes along the longest side, 2 to 100000 [default " +
                      std::to_string(defaults.resolution.value_or(64)) + "]")
      ->check(whole_number(2, 100000))
      ->type_name("N");
  verb.add_option("--spacing", texts.spacing,
                  std::string("distance between nodes, instead [") + length_unit_text + "]")
      ->type_name("H");
  verb.add_option("--bounds", texts.bounds, "the box: x0,y0,z0,x1,y1,z1 [length]")
      ->type_name("X0,Y0,Z0,X1,Y1,Z1");
  add_share_option(verb, "padding", texts.padding, 1000,
                   "without --bounds: margin around the input, in its longest side, 0.1 or 10% "
                   "[default " +
                       number_text(defaults.padding) + "]");
}

SpaceRequest space_request(const SpaceArguments& texts, const Session& session) {
  SpaceRequest request{texts.method.method(), session.flip, texts.estimate_normals};
  check_method<SpaceDomain>(request.method);
  return request;
}

namespace {

VolumeMeaning meaning_named(const std::string& word) {
  return word == "mask"       ? VolumeMeaning::mask
         : word == "distance" ? VolumeMeaning::distance
         : word == "density"  ? VolumeMeaning::density
                              : VolumeMeaning::automatic;
}

Shape shape_of_volume(Volume volume, const std::string& file, const SpaceArguments& texts,
                      bool redistance, Session& session) {
  warn_without_box(file, session);
  VolumeMeaning meaning = meaning_named(texts.meaning);
  const bool voxels =
      io::format_to_read(io::extension_to_read(file), file, {io::Kind::volume}).read_voxels !=
      nullptr;
  return naming(file, [&]() -> Shape {
    if (voxels && !redistance && meaning == VolumeMeaning::automatic) {
      check_side_of_mask(volume, session.flip);
      meaning = VolumeMeaning::mask;
    }
    if (redistance) {
      Shape shape = shape_at_level(volume, 0);
      shape.request.flip = session.flip;
      return shape;
    }
    std::optional<double> threshold;
    if (!texts.threshold.empty()) threshold = parse_number("threshold", texts.threshold);
    return shape_of(std::move(volume), meaning, threshold, session.flip);
  });
}

Shape read_shape(const std::string& file, const SpaceArguments& texts, bool first,
                 Session& session) {
  io::format_to_read(io::extension_to_read(file), file,
                     {io::Kind::surface, io::Kind::cloud, io::Kind::volume});
  io::Content content = io::read_content(file, first ? texts.field : "");
  const bool redistance = first && texts.redistance;
  if (auto* volume = std::get_if<Volume>(&content))
    return shape_of_volume(std::move(*volume), file, texts, redistance, session);
  if (redistance)
    throw InputError(
        file + " is no volume: option redistance is for " + io::read_extensions({io::Kind::volume}),
        "options-conflict");
  Shape shape;
  shape.request.flip = session.flip;
  const auto* tets = std::get_if<io::TetFile>(&content);
  shape.surface = tets ? boundary_of(*tets) : std::get<PolygonSoup>(std::move(content));
  naming(file, [&] { return bounding_box(shape.surface); });  // complains
  return shape;
}

/// One value for all of the input, or one for each face or point.
std::vector<double> values_of(const std::string& text, const CsgShapes& shapes,
                              const InputSize& size) {
  if (shapes.all.size() > 1 || shapes.all.front().field)
    throw InputError(
        "option values is for one mesh, soup or cloud; a volume and shapes that are "
        "combined are moved by option offset",
        "options-conflict");
  const PolygonSoup& input = shapes.all.front().surface;
  if (const auto field = input.scalars.find(text); field != input.scalars.end()) {
    if (input.n_faces() > 0)
      throw InputError("option values: a surface has values for its parts, and " + text +
                           " has them at its vertices",
                       "options-conflict");
    return {field->second.begin(), field->second.end()};
  }
  std::vector<double> values = parse_lengths("values", text, size);
  if (values.size() == 1) return values;
  std::vector<int> part;
  if (input.n_faces() > 0) {
    part = parts_of_faces(input);
  } else {
    part.resize(std::size_t(input.n_vertices()));
    std::iota(part.begin(), part.end(), 0);
  }
  const int n = part.empty() ? 0 : 1 + *std::max_element(part.begin(), part.end());
  if (values.size() != std::size_t(n))
    throw InputError("option values: there are " + std::to_string(values.size()) + " numbers for " +
                         (input.n_faces() > 0 ? counted(n, "connected part", "connected parts")
                                              : counted(n, "point", "points")),
                     "sizes-differ");
  std::vector<double> of_elements;
  for (const int p : part) of_elements.push_back(values[p]);
  return of_elements;
}

/// Of the options that were given, those that a method has.
OptionValues known_options(const std::string& method, const GivenOptions& given) {
  OptionValues out;
  const auto info = Registry<SpaceDomain>::instance().find(method)->info;
  for (const auto& [name, text] : given)
    for (const OptionInfo& known : info.options)
      if (known.name == name) out.emplace_back(name, text);
  return out;
}

}  // namespace

void warn_without_box(const std::string& file, Session& session) {
  const io::Format& format =
      io::format_to_read(io::extension_to_read(file), file, {io::Kind::volume});
  if (format.no_box)
    session.report.warn(
        "grid-unplaced",
        file +
            " holds no origin and spacing: its first node is taken at 0, 0, 0 and the "
            "others 1 apart, and lengths are in that unit (VTK image data, NRRD and "
            "NumPy archives hold them)");
}

CsgShapes read_shapes(SpaceArguments& texts, Session& session) {
  if (texts.redistance && texts.meaning != "auto")
    throw InputError("option redistance does not go with option as", "options-conflict");
  CsgShapes shapes;
  shapes.all.push_back(read_shape(texts.input, texts, true, session));
  for (const auto& [how, files] : {std::pair(Boolean::unite, &texts.unite),
                                   {Boolean::intersect, &texts.intersect},
                                   {Boolean::subtract, &texts.subtract}}) {
    for (const std::string& file : *files) {
      shapes.all.push_back(read_shape(file, texts, false, session));
      shapes.csg.operations.push_back(how);
    }
  }
  const InputSize size = [&] { return longest_side(shapes); };
  shapes.csg.blend = parse_radius("blend", texts.blend, size);
  if (!texts.offset.empty()) shapes.csg.offset = parse_length("offset", texts.offset, size);
  Shape& first = shapes.all.front();
  const AnyMethod own = first.request.method;  // where the level of a volume is measured anew
  const bool flip = first.request.flip;        // what is still to be done of it
  first.request = space_request(texts, session);
  first.request.flip = flip;
  if (first.request.method.name().empty())
    first.request.method = AnyMethod::named(own.name(), first.request.method.values());
  if (!texts.operand_method.empty() && shapes.all.size() == 1)
    throw InputError("option operand-method: there is no shape but INPUT", "options-conflict");
  for (std::size_t s = 1; s < shapes.all.size(); ++s) {
    Shape& shape = shapes.all[s];
    const std::string name = !texts.operand_method.empty() ? texts.operand_method
                             : !texts.method.name.empty()  ? texts.method.name
                                                           : std::string(SpaceAutomatic::method);
    shape.request = {AnyMethod::named(name, known_options(name, texts.method.options)),
                     shape.request.flip, texts.estimate_normals && shape.surface.n_faces() == 0};
    check_method<SpaceDomain>(shape.request.method);
  }
  check_combination(shapes.csg, shapes.all.size());
  if (!texts.values.empty()) {
    std::vector<double> values = values_of(texts.values, shapes, size);
    shapes.all.front().request.values = std::move(values);
  }
  return shapes;
}

GridOptions grid_request(const SpaceArguments& texts, const InputSize& size) {
  GridOptions request;
  if (texts.resolution > 0) request.resolution = texts.resolution;
  if (!texts.spacing.empty()) request.spacing = parse_length("spacing", texts.spacing, size);
  if (request.spacing && !(*request.spacing > 0))
    throw InputError("option spacing takes a positive length", "option-value");
  request.padding = texts.padding;
  if (!texts.bounds.empty()) {
    const std::vector<double> numbers = parse_numbers("bounds", texts.bounds);
    if (numbers.size() != 6)
      throw InputError("option bounds takes six numbers, x0,y0,z0,x1,y1,z1, found " +
                           std::to_string(numbers.size()),
                       "option-value");
    request.bounds.emplace();
    std::copy(numbers.begin(), numbers.end(), request.bounds->begin());
  }
  return request;
}

void add_smoothing_option(CLI::App& verb, std::string& smoothing, const std::string& when) {
  verb.add_option("--smoothing", smoothing,
                  when +
                      ": regularized winding number, convolved with a Gaussian of this deviation "
                      "[" +
                      length_unit_text + "; default 0, none]")
      ->type_name("S");
}

}  // namespace littoral::cli
