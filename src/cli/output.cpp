#include "cli/output.h"

#include <filesystem>

#include "api/tet/tet_boundary.h"
#include "base/counted.h"
#include "base/stopwatch.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::cli {

using io::Kind;

void check_outputs(const std::vector<std::string>& files, const io::Kinds& kinds) {
  for (const std::string& file : files) {
    io::format_to_write(file, kinds);
    check_before([&] { io::check_writable(file); });
  }
}

void check_holds_confidence(const std::string& file) {
  if (io::is_written_as(file, {Kind::table, Kind::page, Kind::picture})) return;
  if (io::is_written_as(file, {Kind::field}) &&
      io::format_to_write(file, {Kind::field}).more_values)
    return;
  std::string able;
  for (const io::Format& format : io::formats())
    if (format.write_table || (format.write_field && format.more_values))
      able.append(" ").append(format.extension);
  throw InputError(file + " holds one number per vertex: confidence is written to" + able,
                   "options-conflict");
}

void add_output_option(CLI::App& verb, std::string& file, const std::string& help) {
  verb.add_option("-o,--output", file, help)->required()->type_name("OUT");
}

void add_output_option(CLI::App& verb, std::vector<std::string>& files, const std::string& help) {
  add_repeated_option(verb, "-o,--output", files, help + "; may be repeated")
      ->required()
      ->type_name("OUT");
}

std::string title_of(const std::string& input) {
  return io::is_standard_stream(input) ? "standard input"
                                       : std::filesystem::path(input).stem().string();
}

void keep_upright(io::Scene& scene, const std::string& input) {
  const bool printed = io::has_extension(input, ".stl") || io::has_extension(input, ".3mf");
  if (scene.up || scene.towards_eye || !printed) return;
  const Vec3 size = (scene.points.colwise().maxCoeff() - scene.points.colwise().minCoeff());
  if (size[2] > 0.01 * size.maxCoeff()) scene.up = Vec3::UnitZ();  // flat ones are seen face-on
}

void write_result(const std::string& file, const PolygonSoup& result, const std::string& field,
                  const std::string& input, const Report& report,
                  const std::function<void(io::Scene&)>& add) {
  if (io::is_written_as(file, {Kind::field})) return io::write_field(file, result, field);
  io::Scene scene = io::make_scene(result, field);
  if (add) add(scene);
  keep_upright(scene, input);
  io::describe(scene, title_of(input), report);
  io::write_scene(file, scene);
}

void write_tet_result(const std::string& file, const TetMesh& mesh, const VecX& values,
                      const std::string& input, const Report& report) {
  const std::string field = "distance";
  const io::TetFile result{mesh, {}, {{field, values}}};
  if (!io::is_written_as(file, {Kind::picture, Kind::page})) return write_tet_values(file, result);
  write_result(file, drawn_surface(result), field, input, report);
}

void finish(const std::vector<std::string>& files, const Task& task, Session& session,
            const std::function<void(const std::string&)>& write) {
  {
    const Stopwatch watch(session.report, "write");
    double written = 0;
    for (const std::string& file : files) {
      task.checkpoint(written++ / static_cast<double>(files.size()));
      write(file);
    }
  }
  session.print_report();
}

void check_level_outputs(const std::vector<std::string>& out, std::size_t levels,
                         const io::Kinds& kinds) {
  check_outputs(out, kinds);
  if (out.size() != 1 && out.size() != levels)
    throw InputError((out.size() == 1 ? "there is " : "there are ") +
                         counted(out.size(), "output file", "output files") + " for " +
                         counted(levels, "level", "levels") + ": name one for all, or one for each",
                     "usage");
}

void write_lines(const std::vector<std::string>& out, const SurfaceMesh& mesh,
                 const std::vector<LevelLines>& levels) {
  for (std::size_t i = 0; i < out.size(); ++i)
    io::write_surface(out[i], join_lines(mesh, out.size() == 1 ? levels : std::vector{levels[i]}));
}

}  // namespace littoral::cli
