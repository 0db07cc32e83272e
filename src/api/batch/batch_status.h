#pragma once
// status.jsonl: what became of each job, and what the next run knows from it.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/platform/file_lock.h"
#include "littoral/batch.h"

namespace littoral {

/// "status.jsonl", or "status.3-of-8.jsonl" of a shard.
std::string status_file_name(int shard, int shards);
/// Is this, below the folder, a name of such a file?
bool is_status_file(const std::filesystem::path& path);

/// A line of the file.
struct BatchLine {
  const BatchJob& job;
  BatchOutcome outcome;
  std::string hash;
  double seconds = 0, peak_memory = 0;
  int attempts = 1;
  std::vector<std::string> outputs{};  // below the folder
};

/// The file of a shard; one process at a time holds it.
class BatchStatusFile {
 public:
  /// Makes the folder. A line that was not finished is taken away. Throws IoError.
  BatchStatusFile(const std::filesystem::path& folder, int shard, int shards);
  /// Adds a whole line or, throwing IoError, none.
  void add(const BatchLine& line);
  /// A place for unfinished results that only the holder of this file uses.
  const std::filesystem::path& temporary() const { return temporary_; }

 private:
  std::filesystem::path path_, temporary_;
  FileLock lock_;
  std::ofstream out_;
  std::uintmax_t size_ = 0;
};

/// What is done, by all status files of a folder: the hash of the input under the job's name, where
/// the options were these and the outputs are still there.
class BatchHistory {
 public:
  BatchHistory() = default;
  explicit BatchHistory(const std::filesystem::path& folder);
  /// The input's hash when the job was done; empty where it was not, or in another way.
  std::string hash_when_done(const BatchJob& job) const;

 private:
  struct Done {
    std::string hash, options;
    std::vector<std::string> outputs;
  };
  std::filesystem::path folder_;
  std::unordered_map<std::string, Done> done_;
};

}  // namespace littoral
