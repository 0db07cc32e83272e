#pragma once
// Many inputs, each in a process of its own: what one of them does to its process, a crash, a hang,
// a lack of memory, is a line in a file and not the end of the rest.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "littoral/context.h"

namespace littoral {

/// One input and what is to become of it.
struct BatchJob {
  std::string input;                 // a file, or what the work takes for one
  std::string name;                  // of its results below the folder, "a/chair"; no two have one
  std::vector<std::string> options;  // of the work
};

/// How a job ended.
struct BatchOutcome {
  std::string status = "done";  // or the kind of failure: "input", "memory", "time", "crash", ...
  std::string message;          // of a failure
  std::string report;           // JSON, or empty
};

/// What is done, in a process of its own, for each job.
struct BatchWork {
  /// Writes results into the folder, which is empty; what is in it in the end is moved to beside
  /// the job's name. An exception is a failure.
  std::function<BatchOutcome(const BatchJob& job, const std::filesystem::path& folder)> run;
  /// Tells whether an input is as it was; by default the SHA-256 of the file.
  std::function<std::string(const BatchJob& job, const std::filesystem::path& folder)> hash{};
  /// What must happen around a fork, in an interpreter for instance.
  std::function<void()> before_fork{}, after_fork_in_parent{}, after_fork_in_child{};
};

/// How a batch runs.
struct BatchOptions {
  std::filesystem::path folder;  // of results, status.jsonl and nothing else
  int shard = 1, shards = 1;     // this part of so many
  bool resume = true;            // leave out what is done, with these options and this content
  int retries = 0;               // of what crashed, took too long or could not be written
  bool fail_fast = false;        // end with the first failure
  int processes = 0;             // at once; 0: one for each core
  double time_limit = 0;         // of a job [seconds]; 0: none
  double memory_limit = 0;       // of a job, what it can write to [bytes]; 0: none
  double start_patience = 10;    // to wait for a place for a process [seconds]
};

/// Failures that say the same but for names, numbers and what is quoted.
struct BatchFailures {
  std::string status, message;  // of the first
  std::string example;          // its input
  std::size_t count = 0;
};

/// What became of a batch.
struct BatchSummary {
  std::size_t jobs = 0;  // of this shard
  std::size_t done = 0, unchanged = 0, failed = 0;
  double seconds = 0;                     // by the clock
  double start_seconds = 0;               // from asking for a process to its work, on average
  double peak_memory = 0;                 // of the largest process [bytes]
  std::vector<BatchFailures> failures{};  // the most frequent first
};

/// A process that is ready to fork others. Made early, before this one has threads or much memory.
class Batch {
 public:
  /// Throws IoError if there can be no process.
  explicit Batch(BatchWork work);
  ~Batch();
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;

  /// Does the jobs of the shard: every shards-th of the list. Each that ends, however it does, adds
  /// a line to the folder's status.jsonl (of shards status.I-of-N.jsonl). Results are moved into
  /// place when they are whole. Throws InputError for bad options and two jobs of one name, IoError
  /// where the folder cannot be written to, another batch writes to it or the system starts no
  /// process, Cancelled; what was done by then is known to the next run. To be called once.
  BatchSummary run(const std::vector<BatchJob>& jobs, const BatchOptions& options,
                   const Context& context = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace littoral
