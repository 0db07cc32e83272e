#include "api/batch/batch_status.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>

#include "littoral/error.h"

namespace littoral {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

std::string one_line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// A text as it comes back from a line.
std::string as_written(const std::string& text) {
  return Json::parse(one_line_of(Json(text))).get<std::string>();
}

std::string status_name(int shard, int shards) {
  if (shards == 1) return "status";
  return "status." + std::to_string(shard) + "-of-" + std::to_string(shards);
}

/// The folder, made where there is none.
const fs::path& made_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder))
    throw IoError("cannot make the folder " + folder.string() + ": " +
                      (error ? error.message() : "there is a file of that name"),
                  "cannot-write");
  return folder;
}

}  // namespace

std::string status_file_name(int shard, int shards) {
  return status_name(shard, shards) + ".jsonl";
}

bool is_status_file(const fs::path& path) {
  return path.string().starts_with("status.") && path.extension() == ".jsonl" &&
         !path.has_parent_path();
}

BatchStatusFile::BatchStatusFile(const fs::path& folder, int shard, int shards)
    : path_(made_folder(folder) / status_file_name(shard, shards)),
      temporary_(folder / ("." + status_name(shard, shards) + ".tmp")),
      lock_(path_) {
  {
    // Up to the end of the last line.
    std::ifstream in(path_, std::ios::binary);
    std::uintmax_t at = 0;
    for (std::string line; std::getline(in, line);) {
      at += line.size() + 1;
      if (!in.eof()) size_ = at;
    }
  }
  std::error_code error;
  if (fs::file_size(path_, error) != size_) fs::resize_file(path_, size_, error);
  errno = 0;
  out_.open(path_, std::ios::binary | std::ios::app);
  if (!out_ || error)
    throw IoError("cannot write " + path_.string() + ": " +
                      (error ? error.message() : std::generic_category().message(errno)),
                  "cannot-write");
  // What a run that was ended by force left behind.
  fs::remove_all(temporary_, error);
  fs::create_directory(temporary_, error);
  if (error)
    throw IoError("cannot make the folder " + temporary_.string() + ": " + error.message(),
                  "cannot-write");
}

void BatchStatusFile::add(const BatchLine& line) {
  Json json;
  json["input"] = line.job.input;
  json["name"] = line.job.name;
  json["hash"] = line.hash;
  json["options"] = line.job.options;
  json["status"] = line.outcome.status;
  json["message"] = line.outcome.message;
  json["seconds"] = std::round(line.seconds * 1e4) / 1e4;
  json["peak_memory"] = static_cast<std::uint64_t>(line.peak_memory);
  json["attempts"] = line.attempts;
  json["outputs"] = line.outputs;
  json["report"] = nullptr;
  if (!line.outcome.report.empty()) {
    json["report"] = Json::parse(line.outcome.report, nullptr, false);
    if (json["report"].is_discarded()) json["report"] = line.outcome.report;
  }
  const std::string text = one_line_of(json) + "\n";
  errno = 0;
  out_ << text << std::flush;
  if (out_) {
    size_ += text.size();
    return;
  }
  const int reason = errno ? errno : EIO;
  out_.close();
  std::error_code ignored;
  fs::resize_file(path_, size_, ignored);
  throw IoError("cannot write " + path_.string() + ": " + std::generic_category().message(reason),
                "cannot-write");
}

BatchHistory::BatchHistory(const fs::path& folder) : folder_(folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (is_status_file(entry->path().filename())) files.push_back(entry->path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    for (std::string text; std::getline(in, text);) {
      const Json line = Json::parse(text, nullptr, false);
      if (!line.is_object()) continue;
      try {
        if (line.at("status") != "done") continue;
        done_[line.at("name").get<std::string>()] = {
            line.at("hash"), one_line_of(line.at("options")), line.at("outputs")};
      } catch (const Json::exception&) {
        continue;  // a line of somebody else
      }
    }
  }
}

std::string BatchHistory::hash_when_done(const BatchJob& job) const {
  const std::string name = as_written(job.name);
  const auto found = done_.find(name);
  if (found == done_.end() || found->second.options != one_line_of(Json(job.options))) return "";
  const auto is_there = [&](const std::string& output) {
    std::error_code error;
    // Names that are no UTF-8 are written with signs in place of some bytes.
    const bool begins = name != job.name && output.rfind(name, 0) == 0;
    return fs::exists(folder_ / (begins ? job.name + output.substr(name.size()) : output), error);
  };
  if (!std::all_of(found->second.outputs.begin(), found->second.outputs.end(), is_there)) return "";
  return found->second.hash;
}

}  // namespace littoral
