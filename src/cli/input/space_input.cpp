#include "cli/input/space_input.h"

#include <charconv>
#include <cmath>

#include "io/read.h"
#include "io/volume/volume.h"
#include "io/write.h"
#include "io/write_table.h"
#include "littoral/error.h"
#include "sources/level_points.h"

namespace littoral::cli {

void add_space_input(CLI::App& verb, SpaceArguments& texts, Session& session) {
  verb.add_option("INPUT", texts.input,
                  "mesh, soup or point cloud: .obj .ply .off .stl .pc .xyz .pcd")
      ->required()
      ->type_name("");
  verb.add_flag("--estimate-normals", texts.estimate_normals,
                "of a point cloud: compute normals from neighbouring points");
  verb.add_flag("--flip", session.flip, "reverse all normals: the other side is positive");
}

void add_space_method(CLI::App& verb, SpaceArguments& texts, const std::string& fallback) {
  add_methods(verb, texts.method, Registry<SpaceDomain>::instance().infos(), fallback);
}

void add_shape_options(CLI::App& verb, SpaceArguments& texts, bool with_offset) {
  const auto group = [](CLI::Option* option) { return option->group("Several shapes"); };
  const std::string kinds = ": mesh, soup, cloud, or volume of distance; may be repeated";
  for (const auto& [name, files, what] :
       {std::tuple("--unite", &texts.unite, "also this shape"),
        {"--intersect", &texts.intersect, "only what lies within this shape"},
        {"--subtract", &texts.subtract, "without this shape"}})
    group(add_repeated_option(verb, name, *files, what + kinds))->type_name("FILE");
  group(verb.add_option("--operand-method", texts.operand_method,
                        "of the shapes after INPUT [default: as --method where that is given, "
                        "otherwise tori for clouds, winding for all else]"))
      ->type_name("NAME");
  group(verb.add_option("--blend", texts.blend,
                        "round corners where shapes meet, this far from them [length; default 0]"))
      ->check(CLI::Range(0.0, 1e300).description(""))
      ->type_name("R");
  if (with_offset)
    group(verb.add_option("--offset", texts.offset,
                          "move the surface outward, or if negative inward [length; default 0]"))
        ->type_name("D");
  group(verb.add_flag("--redistance", texts.redistance,
                      "INPUT is a volume of any values: distance to where they are zero"));
}

void add_grid_options(CLI::App& verb, SpaceArguments& texts) {
  verb.add_option("--resolution", texts.resolution,
                  "nodes along the longest side, 2 to 100000 [default 64]")
      ->check(CLI::Range(2, 100000).description(""))
      ->type_name("N");
  verb.add_option("--spacing", texts.spacing, "distance between nodes, instead [length]")
      ->check(CLI::PositiveNumber.description(""))
      ->type_name("H");
  verb.add_option("--bounds", texts.bounds, "the box: x0,y0,z0,x1,y1,z1 [length]")
      ->type_name("BOX");
  verb.add_option("--padding", texts.padding,
                  "without --bounds: margin around the input, in its longest side [default 0.25]")
      ->check(CLI::Range(0.0, 1000.0).description(""))
      ->type_name("F");
}

SpaceRequest space_request(const SpaceArguments& texts, const AnyMethod& fallback,
                           const Session& session) {
  SpaceRequest request{texts.method.method(), session.flip, texts.estimate_normals};
  if (texts.method.name.empty())
    request.method = AnyMethod::named(fallback.name(),
                                      {texts.method.options.begin(), texts.method.options.end()});
  check_method<SpaceDomain>(request.method);
  return request;
}

namespace {

Shape read_shape(const std::string& file, bool redistance, double level) {
  Shape shape;
  if (!io::is_volume(file)) {
    if (redistance) throw InputError(file + " is no volume: --redistance is for .vti .nrrd .npy");
    shape.surface = io::read_surface(file);
    return shape;
  }
  Volume field = io::read_volume(file);
  try {
    if (redistance)
      shape.surface = level_points(field, level, {});
    else
      shape.field = std::move(field);
  } catch (const InputError& e) {
    throw InputError(file + ": " + e.what());
  }
  return shape;
}

}  // namespace

namespace {

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

CsgShapes read_shapes(SpaceArguments& texts, const Session& session, const AnyMethod& plain) {
  CsgShapes shapes;
  shapes.all.push_back(read_shape(texts.input, texts.redistance, texts.at_level));
  for (const auto& [how, files] : {std::pair(Boolean::unite, &texts.unite),
                                   {Boolean::intersect, &texts.intersect},
                                   {Boolean::subtract, &texts.subtract}}) {
    for (const std::string& file : *files) {
      shapes.all.push_back(read_shape(file, false, 0));
      shapes.csg.operations.push_back(how);
    }
  }
  shapes.csg.blend = texts.blend;
  shapes.csg.offset = texts.offset;
  Shape& first = shapes.all.front();
  const bool as_plain = shapes.plain() && !texts.redistance && !plain.name().empty();
  first.request =
      space_request(texts, as_plain ? plain : method_for_points(first.surface), session);
  if (!texts.operand_method.empty() && shapes.all.size() == 1)
    throw InputError("option --operand-method: there is no shape but INPUT");
  for (std::size_t s = 1; s < shapes.all.size(); ++s) {
    Shape& shape = shapes.all[s];
    const std::string name = !texts.operand_method.empty() ? texts.operand_method
                             : !texts.method.name.empty()  ? texts.method.name
                                                          : method_for_points(shape.surface).name();
    shape.request = {AnyMethod::named(name, known_options(name, texts.method.options)),
                     session.flip, texts.estimate_normals && shape.surface.n_faces() == 0};
    check_method<SpaceDomain>(shape.request.method);
  }
  check_combination(shapes.csg, shapes.all.size());
  return shapes;
}

GridOptions grid_request(const SpaceArguments& texts) {
  GridOptions request;
  if (texts.resolution > 0) request.resolution = texts.resolution;
  if (texts.spacing > 0) request.spacing = texts.spacing;
  request.padding = texts.padding;
  if (!texts.bounds.empty()) {
    const std::vector<double> numbers = parse_numbers("--bounds", texts.bounds);
    if (numbers.size() != 6) throw InputError("option --bounds takes x0,y0,z0,x1,y1,z1");
    request.bounds.emplace();
    std::copy(numbers.begin(), numbers.end(), request.bounds->begin());
  }
  return request;
}

void add_query_files(CLI::App& verb, std::string& points, std::vector<std::string>& out) {
  verb.add_option("--points", points,
                  "where to evaluate: the vertices of any surface or cloud file, or .csv or .txt "
                  "with x, y, z first")
      ->required()
      ->type_name("FILE");
  verb.add_option("-o,--output", out, "where to write: .csv .txt .npy .ply; may be repeated")
      ->required()
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("OUT");
}

MatX3 read_queries(const std::string& file) {
  const std::string extension = extension_of(file);
  if (extension == ".csv" || extension == ".txt")
    return io::read_columns(io::read_bytes(file), file);
  return io::read_surface(file).points;
}

void write_query_table(const std::vector<std::string>& out, const MatX3& points,
                       const Table& table) {
  for (const std::string& file : out) {
    if (extension_of(file) == ".ply") {
      PolygonSoup cloud;
      cloud.points = points;
      for (std::size_t c = 0; c < table.names.size(); ++c)
        cloud.scalars[table.names[c]] = table.columns.col(static_cast<Eigen::Index>(c));
      io::write_surface(file, cloud);
    } else {
      io::write_table(file, table.names, table.columns);
    }
  }
}

}  // namespace littoral::cli
