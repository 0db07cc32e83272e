#include "cli/batch/job_list.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <system_error>

#include "base/counted.h"
#include "base/platform/glob.h"
#include "io/formats.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace fs = std::filesystem;

namespace {

/// A path as a name below the folder of results.
std::string name_of(const fs::path& path) {
  fs::path name;
  for (const fs::path& part : path.lexically_normal().relative_path())
    if (part != ".." && part != ".") name /= part;
  return name.string();
}

bool may_be_input(const fs::path& path) {
  using io::Kind;
  return io::is_named_as(path,
                         {Kind::surface, Kind::cloud, Kind::volume, Kind::voxels, Kind::tets});
}

/// The inputs below a folder.
class FolderWalk {
 public:
  FolderWalk(fs::path folder, fs::path without)
      : folder_(std::move(folder)), without_(std::move(without)) {
    add(folder_);
    std::sort(jobs.begin(), jobs.end(),
              [](const ListedJob& a, const ListedJob& b) { return a.input < b.input; });
  }

  std::vector<ListedJob> jobs;

 private:
  void add(const fs::path& folder) {
    std::error_code error, ignored;
    const fs::path real = fs::canonical(folder, error);
    // A link to a folder that this one lies in would lead round and round.
    if (std::find(open_.begin(), open_.end(), real) != open_.end()) return;
    open_.push_back(real);
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
      const fs::path& path = entry->path();
      if (path.filename().string().front() == '.') continue;
      if (!entry->is_directory(ignored)) {
        if (may_be_input(path))
          jobs.push_back({path.string(), name_of(path.lexically_relative(folder_)), {}, ""});
      } else if (!fs::equivalent(path, without_, ignored)) {
        add(path);
      }
    }
    if (error)
      throw InputError("cannot read the folder " + folder.string() + ": " + error.message(),
                       "cannot-read");
    open_.pop_back();
  }

  fs::path folder_, without_;
  std::vector<fs::path> open_;  // the folders that the one being read lies in
};

std::vector<ListedJob> of_folder(const fs::path& folder, const fs::path& without) {
  std::vector<ListedJob> jobs = FolderWalk(folder, without).jobs;
  if (jobs.empty())
    throw InputError("there are no inputs in the folder " + folder.string() +
                         ": files of the formats that 'littoral formats' lists",
                     "bad-file");
  return jobs;
}

std::vector<ListedJob> of_pattern(const std::string& pattern) {
  if (pattern.find("**") != std::string::npos)
    throw InputError(
        "'**' in " + pattern + " matches no subfolders: name the folder, all of which is taken",
        "nothing-there");
  const std::string fixed = pattern.substr(0, pattern.find_first_of("*?["));
  const fs::path root = fixed.substr(0, fixed.rfind('/') + 1);  // 0 where there is none
  std::vector<ListedJob> jobs;
  for (const std::string& path : matching_paths(pattern)) {
    if (fs::is_directory(path)) continue;
    const fs::path below = root.empty() ? fs::path(path) : fs::path(path).lexically_relative(root);
    jobs.push_back({path, name_of(below), {}, ""});
  }
  if (jobs.empty()) throw InputError("no file matches " + pattern, "nothing-there");
  return jobs;
}

/// A line split at spaces; quotes of either kind and backslashes as in a shell.
std::vector<std::string> shell_words(const std::string& line) {
  std::vector<std::string> words;
  bool within = false;
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote == 0 && (c == ' ' || c == '\t' || c == '\r')) {
      within = false;
      continue;
    }
    if (!within) words.emplace_back();
    within = true;
    if (quote == 0 && (c == '"' || c == '\''))
      quote = c;
    else if (c == quote)
      quote = 0;
    else if (c == '\\' && quote != '\'' && i + 1 < line.size())
      words.back() += line[++i];
    else
      words.back() += c;
  }
  if (quote != 0) throw InputError("a quotation does not end", "bad-file");
  return words;
}

std::optional<ListedJob> of_text(const std::string& line) {
  std::vector<std::string> words = shell_words(line);
  if (words.empty() || words.front().front() == '#') return std::nullopt;
  ListedJob job{words.front(), "", {words.begin() + 1, words.end()}, ""};
  return job;
}

/// The cells of a row, RFC 4180, of one line.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"')
      cells.back() += line[++i];
    else if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else if (c != '\r' || quoted)
      cells.back() += c;
  }
  if (quoted) throw InputError("a quotation does not end", "bad-file");
  return cells;
}

/// A value of an option: true is the option alone, false is none.
void add_word(std::vector<std::string>& words, const std::string& name, const std::string& value) {
  if (value == "true")
    words.push_back("--" + name);
  else if (value != "false")
    words.push_back("--" + name + "=" + value);
}

/// Rows of a table, whose first names the columns.
class TableRows {
 public:
  std::optional<ListedJob> operator()(const std::string& line) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) return std::nullopt;
    const std::vector<std::string> cells = cells_of(line);
    if (columns_.empty()) {
      if (std::find(cells.begin(), cells.end(), "input") == cells.end())
        throw InputError("the first line names the columns, and one of them is 'input'",
                         "bad-file");
      columns_ = cells;
      return std::nullopt;
    }
    if (cells.size() != columns_.size())
      throw InputError(counted(cells.size(), "cell", "cells") + " for " +
                           counted(columns_.size(), "column", "columns"),
                       "bad-file");
    ListedJob job;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (columns_[c] == "input")
        job.input = cells[c];
      else if (!cells[c].empty())
        add_word(job.words, columns_[c], cells[c]);
    }
    return job;
  }

 private:
  std::vector<std::string> columns_;
};

std::optional<ListedJob> of_json(const std::string& line) {
  using Json = nlohmann::ordered_json;
  if (line.find_first_not_of(" \t\r") == std::string::npos) return std::nullopt;
  Json json;
  try {
    json = Json::parse(line);
  } catch (const Json::exception&) {
    throw InputError("the line is not valid JSON", "bad-file");
  }
  if (!json.is_object()) throw InputError("expected an object {\"input\": ...}", "bad-file");
  ListedJob job;
  const auto text = [](const Json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
  };
  for (const auto& [key, value] : json.items()) {
    if (value.is_object() || (key == "input" && !value.is_string()))
      throw InputError("'" + key + "' is no text" + (key == "input" ? "" : ", number or list"),
                       "bad-file");
    if (key == "input")
      job.input = value;
    else if (value.is_array())
      for (const Json& each : value) add_word(job.words, key, text(each));
    else if (!value.is_null())
      add_word(job.words, key, text(value));
  }
  return job;
}

template <class Read>
std::vector<ListedJob> of_list(const std::string& list, Read read) {
  std::ifstream in(list, std::ios::binary);
  if (!in) throw InputError("cannot read " + list, "cannot-read");
  std::vector<ListedJob> jobs;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    const std::string where = list + ":" + std::to_string(++number) + ": ";
    if (number == 1 && line.rfind("\xEF\xBB\xBF", 0) == 0) line.erase(0, 3);
    try {
      std::optional<ListedJob> job = read(line);
      if (!job) continue;
      if (job->input.empty()) throw InputError("there is no input", "nothing-given");
      job->name = name_of(job->input);
      job->line = where;
      jobs.push_back(std::move(*job));
    } catch (const InputError& e) {
      throw InputError(where + e.what(), e.code());
    }
  }
  if (jobs.empty()) throw InputError("there are no inputs in the list " + list, "bad-file");
  return jobs;
}

std::vector<ListedJob> all_jobs(const std::string& jobs, const fs::path& without) {
  std::error_code error;
  if (fs::is_directory(jobs, error)) return of_folder(jobs, without);
  if (!fs::exists(jobs, error)) {
    if (is_pattern(jobs)) return of_pattern(jobs);
    throw InputError("there is no file or folder " + jobs, "cannot-read");
  }
  if (io::has_extension(jobs, ".txt")) return of_list(jobs, of_text);
  if (io::has_extension(jobs, ".csv")) return of_list(jobs, TableRows());
  if (io::has_extension(jobs, ".jsonl")) return of_list(jobs, of_json);
  return {{jobs, fs::path(jobs).filename().string(), {}, ""}};
}

}  // namespace

std::vector<ListedJob> listed_jobs(const std::string& jobs, const fs::path& without) {
  std::vector<ListedJob> all = all_jobs(jobs, without);
  const auto short_name = [](const ListedJob& job) {
    return fs::path(job.name).replace_extension().string();
  };
  std::map<std::string, int> count;
  for (const ListedJob& job : all) ++count[short_name(job)];
  // a.obj and a.ply keep their extensions, and then a.obj.gz does, too.
  std::set<std::string> kept;
  for (std::size_t before = all.size() + 1; before != kept.size();) {
    before = kept.size();
    for (const ListedJob& job : all)
      if (count[short_name(job)] > 1 || kept.contains(short_name(job))) kept.insert(job.name);
  }
  for (ListedJob& job : all)
    if (!kept.contains(job.name)) job.name = short_name(job);
  return all;
}

}  // namespace littoral::cli
