#include "littoral/batch.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>
#include <new>
#include <optional>
#include <system_error>
#include <thread>
#include <unordered_map>
#include <utility>

#include "api/batch/batch_failures.h"
#include "api/batch/batch_status.h"
#include "api/batch/batch_text.h"
#include "api/front/running.h"
#include "base/option_table.h"
#include "base/parallel.h"
#include "base/platform/child_process.h"
#include "base/platform/fork_server.h"
#include "base/platform/memory.h"
#include "base/platform/process.h"
#include "base/sha256.h"
#include "littoral/error.h"
#include "solve/direct/dense_products.h"

namespace littoral {

namespace fs = std::filesystem;

namespace {

constexpr double patience = 0.05;     // [seconds] between looks at what was asked to stop
constexpr double redraw = 0.1;        // [seconds] between reports of progress
constexpr double hold_seconds = 0.1;  // before another try to start a process

// What goes to a child and what comes back: texts, each behind its size.

std::string joined(const std::vector<std::string>& texts) {
  std::string out;
  for (const std::string& text : texts) out.append(std::to_string(text.size()) + ":").append(text);
  return out;
}

/// The texts that are whole; a child may have ended while it wrote.
std::vector<std::string> separated(const std::string& bytes) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t begin = bytes.find(':', at) + 1;
    if (begin == 0) break;
    const std::size_t size = std::stoul(bytes.substr(at, begin - at));
    if (size > bytes.size() - begin) break;
    out.push_back(bytes.substr(begin, size));
    at = begin + size;
  }
  return out;
}

BatchOutcome failure(std::string status, std::string message) {
  return {std::move(status), std::move(message), ""};
}

/// What `call` returns, or the failure that its exception is.
template <class Call>
BatchOutcome outcome_of(const Call& call) {
  try {
    return call();
  } catch (const InputError& e) {
    return failure("input", e.what());
  } catch (const UnsupportedError& e) {
    return failure("unsupported", e.what());
  } catch (const IoError& e) {
    return failure(is_about_memory(e) ? "memory" : "io", e.what());
  } catch (const SolveError& e) {
    return failure("solve", e.what());
  } catch (const std::bad_alloc&) {
    return failure("memory", "not enough memory");
  } catch (const std::exception& e) {
    return failure("internal", e.what());
  }
}

// Its stack, and what the products of blocks are copied to.
constexpr double bytes_of_a_thread = (8 << 20) + double(dense::bytes_of_copies);

/// In the child: tells the hash first, so that it is known whatever happens after it.
void do_job(const BatchWork& work, const std::string& request, const ForkServer::Tell& tell) {
  const double room = available_memory() / bytes_of_a_thread;  // for threads beside this
  set_most_threads(1 + static_cast<int>(std::min(room, 1e6)));
  const std::vector<std::string> texts = separated(request);
  const fs::path folder = texts.at(0);
  const std::string& known = texts.at(1);
  const BatchJob job{texts.at(2), texts.at(3), {texts.begin() + 4, texts.end()}};
  const BatchOutcome outcome = outcome_of([&]() -> BatchOutcome {
    const std::string hash = work.hash ? work.hash(job, folder) : sha256_of_file(job.input);
    tell(joined({"hash", hash}));
    return hash == known ? failure("unchanged", "") : work.run(job, folder);
  });
  tell(joined({"end", outcome.status, outcome.message, outcome.report}));
}

struct Told {
  std::string hash;
  std::optional<BatchOutcome> outcome;
};

Told told_by(const ForkEnd& end) {
  Told told;
  const std::vector<std::string> texts = separated(end.told);
  std::size_t at = 0;
  if (texts.size() >= 2 && texts[0] == "hash") {
    told.hash = texts[1];
    at = 2;
  }
  if (texts.size() >= at + 4 && texts[at] == "end")
    told.outcome = BatchOutcome{texts[at + 1], texts[at + 2], texts[at + 3]};
  return told;
}

std::string signal_text(const ForkEnd& end) {
  std::string text = "ended by signal " + std::to_string(end.signal);
  if (const char* name = ::strsignal(end.signal)) text += std::string(" (") + name + ")";
  return text;
}

/// Of a child that did not come to its end.
BatchOutcome outcome_without_word(const ForkEnd& end, const BatchOptions& options) {
  if (end.timed_out)
    return failure("time",
                   "stopped after the time limit of " + number_text(options.time_limit) + " s");
  const std::string said = last_line_of(end.printed);
  return failure("crash", (end.signal != 0 ? signal_text(end) : "ended before it was done") +
                              (said.empty() ? "" : "; its last line: " + said));
}

bool is_worth_retrying(const BatchOutcome& outcome) {
  const std::vector<std::string> for_good{"done", "unchanged", "input", "unsupported", "usage"};
  return std::find(for_good.begin(), for_good.end(), outcome.status) == for_good.end();
}

void check(const std::vector<BatchJob>& jobs, const BatchOptions& options) {
  if (options.shards < 1 || options.shard < 1 || options.shard > options.shards)
    throw InputError("option shard: there is no part " + std::to_string(options.shard) + " of " +
                         std::to_string(options.shards) + "; parts are 1 to " +
                         std::to_string(options.shards),
                     "no-such-element");
  if (options.retries < 0 || options.processes < 0 || !(options.time_limit >= 0) ||
      !(options.memory_limit >= 0))
    throw InputError("limits, retries and numbers of processes must not be negative",
                     "option-value");
  std::unordered_map<std::string, const BatchJob*> names;
  for (const BatchJob& job : jobs) {
    if ((job.input + job.name).find('\0') != std::string::npos)
      throw InputError("the name of the input '" + job.input.substr(0, job.input.find('\0')) +
                       "...' has a zero byte in it");
    const fs::path name = job.name;
    if (name.empty() || name.filename().empty() || name.is_absolute() ||
        std::find(name.begin(), name.end(), "..") != name.end())
      throw InputError("'" + job.name + "', the name for results of " + job.input +
                       ", is none below the folder");
    const auto [known, is_new] = names.emplace(name.lexically_normal().string(), &job);
    if (!is_new)
      throw InputError("the results of " + known->second->input + " and of " + job.input +
                       " would both be named '" + job.name + "': give one of them another name");
  }
}

/// A batch while it runs.
class RunningBatch {
 public:
  RunningBatch(std::unique_ptr<ForkServer>& server, const std::vector<BatchJob>& jobs,
               const BatchOptions& options, Task task)
      : server_(server),
        jobs_(jobs),
        options_(options),
        task_(std::move(task)),
        status_(options.folder, options.shard, options.shards) {
    if (options.resume) history_ = BatchHistory(options.folder);
    const auto shards = std::size_t(options.shards);
    next_ = std::size_t(options.shard) - 1;
    summary_.jobs = jobs.size() > next_ ? (jobs.size() - next_ - 1) / shards + 1 : 0;
    processes_ = std::size_t(options.processes);
    if (processes_ == 0) processes_ = std::max(1u, std::thread::hardware_concurrency());
  }
  ~RunningBatch() {
    server_.reset();  // and with it all children, which would go on writing
    std::error_code ignored;
    fs::remove_all(status_.temporary(), ignored);
  }
  RunningBatch(const RunningBatch&) = delete;
  RunningBatch& operator=(const RunningBatch&) = delete;

  BatchSummary run() {
    while (!over_) {
      task_.checkpoint();
      while (!over_ && running_.size() < processes_ && seconds() >= start_again_at_)
        if (!start_next()) break;
      if (running_.empty() && held_.empty()) break;
      if (const auto end = server_->wait(patience)) finish(*end);
      show_progress();
    }
    summary_.seconds = seconds();
    if (started_ > 0) summary_.start_seconds /= static_cast<double>(started_);
    summary_.failures = failures_.sorted();
    return summary_;
  }

 private:
  struct Attempt {
    std::size_t job = 0;
    int number = 1;
  };

  /// Of this process: one that was ended by force may have children that write for a moment yet.
  fs::path folder_of(std::size_t job) const {
    return status_.temporary() / (std::to_string(process_id()) + "-" + std::to_string(job));
  }

  /// What was held back goes first. Is there any?
  bool start_next() {
    if (!held_.empty()) {
      const Attempt attempt = held_.back();
      held_.pop_back();
      start(attempt);
      return true;
    }
    if (next_ >= jobs_.size()) return false;
    start({next_, 1});
    next_ += std::size_t(options_.shards);
    return true;
  }

  /// The system has no place for another process now. That is no fault of the input: it waits until
  /// one that runs has ended, or a moment. Throws when nothing could be started for too long.
  void hold(const Attempt& attempt, const std::string& why) {
    held_.push_back(attempt);
    const double now = seconds();
    if (full_since_ < 0) full_since_ = now;
    if (running_.empty() && now - full_since_ > options_.start_patience)
      throw IoError(why + "; run again to go on", "system");
    start_again_at_ = now + hold_seconds;
  }

  void start(const Attempt& attempt) {
    const BatchJob& job = jobs_[attempt.job];
    std::error_code error;
    const fs::path folder = folder_of(attempt.job);
    fs::create_directory(folder, error);
    if (error)
      return hold(attempt, "cannot make the folder " + folder.string() + ": " + error.message());
    running_[attempt.job] = attempt;
    std::vector<std::string> texts{folder.string(), history_.hash_when_done(job), job.input,
                                   job.name};
    texts.insert(texts.end(), job.options.begin(), job.options.end());
    server_->start(attempt.job, joined(texts), {options_.time_limit, options_.memory_limit});
  }

  void finish(const ForkEnd& end) {
    const Attempt attempt = running_.at(end.id);
    running_.erase(end.id);
    const fs::path folder = folder_of(attempt.job);
    std::error_code ignored;
    if (!end.not_started.empty()) {
      fs::remove(folder, ignored);  // empty; to look into it takes a file, and there may be no room
      return hold(attempt, end.not_started);
    }
    full_since_ = -1;
    start_again_at_ = 0;
    const BatchJob& job = jobs_[attempt.job];
    Told told = told_by(end);
    BatchLine line{job,
                   told.outcome ? *told.outcome : outcome_without_word(end, options_),
                   told.hash,
                   end.seconds,
                   end.peak_memory,
                   attempt.number};
    if (line.outcome.status == "done") move_results(folder, line);
    fs::remove_all(folder, ignored);
    ++started_;
    summary_.start_seconds += end.start_seconds;
    summary_.peak_memory = std::max(summary_.peak_memory, end.peak_memory);
    if (is_worth_retrying(line.outcome) && attempt.number <= options_.retries)
      return start({attempt.job, attempt.number + 1});
    if (line.outcome.status == "unchanged") {
      ++summary_.unchanged;
      return;
    }
    if (line.outcome.status == "memory" && options_.memory_limit > 0)
      line.outcome.message +=
          "; the limit is " + number_text(options_.memory_limit / 1e6) + " MB for each input";
    // Where results were to be, not where they were made.
    const std::string made = folder.string(),
                      wanted = (options_.folder / job.name).parent_path().string();
    line.outcome.message = replaced(line.outcome.message, made, wanted);
    line.outcome.report = replaced(line.outcome.report, made, wanted);
    status_.add(line);
    if (line.outcome.status == "done") {
      ++summary_.done;
      return;
    }
    ++summary_.failed;
    failures_.add(job, line.outcome);
    over_ = options_.fail_fast;
  }

  /// Moves all that the child has written to beside the job's name.
  void move_results(const fs::path& folder, BatchLine& line) const {
    const fs::path below = fs::path(line.job.name).parent_path();
    try {
      fs::create_directories(options_.folder / below);
      for (const auto& entry : fs::directory_iterator(folder)) {
        const fs::path target = below / entry.path().filename(), whole = options_.folder / target;
        if (is_status_file(target)) {
          line.outcome = failure("io", "a result cannot be named " + target.string() +
                                           ", as the list of what became of all is");
          return;
        }
        if (fs::is_directory(whole)) fs::remove_all(whole);
        fs::rename(entry.path(), whole);
        line.outputs.push_back(target.string());
      }
      std::sort(line.outputs.begin(), line.outputs.end());
    } catch (const fs::filesystem_error& e) {
      line.outcome = failure("io", "cannot write " + e.path2().string() + e.path1().string() +
                                       ": " + e.code().message());
    }
  }

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
  }

  void show_progress() {
    const auto finished = summary_.done + summary_.unchanged + summary_.failed;
    const double now = seconds();
    if (finished == shown_ || (now - shown_at_ < redraw && finished < summary_.jobs)) return;
    const double rate = static_cast<double>(finished) / now;
    const auto left = static_cast<double>(summary_.jobs - finished);
    const std::string text =
        std::to_string(finished) + " of " + std::to_string(summary_.jobs) +
        (summary_.failed > 0 ? ", " + std::to_string(summary_.failed) + " failed" : "") + ", " +
        rounded_text(rate, 3) + " a second, " + duration_text(left / rate) + " left";
    task_.stage(static_cast<double>(finished - shown_) / static_cast<double>(summary_.jobs), text)
        .checkpoint(1);
    shown_ = finished;
    shown_at_ = now;
  }

  std::unique_ptr<ForkServer>& server_;
  const std::vector<BatchJob>& jobs_;
  const BatchOptions& options_;
  Task task_;
  BatchStatusFile status_;
  BatchHistory history_;
  std::map<std::uint64_t, Attempt> running_;
  std::vector<Attempt> held_;
  double full_since_ = -1, start_again_at_ = 0;  // [seconds] of this run; -1: there is place
  std::size_t next_ = 0, processes_ = 1, started_ = 0, shown_ = 0;
  bool over_ = false;
  double shown_at_ = 0;
  const std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  FailureCount failures_;
  BatchSummary summary_;
};

}  // namespace

struct Batch::Impl {
  std::unique_ptr<ForkServer> server;
};

Batch::Batch(BatchWork work) : impl_(std::make_unique<Impl>()) {
  const ForkServer::Hooks hooks{work.before_fork, work.after_fork_in_parent,
                                work.after_fork_in_child};
  impl_->server = std::make_unique<ForkServer>(
      [work = std::move(work)](const std::string& request, const ForkServer::Tell& tell) {
        do_job(work, request, tell);
      },
      hooks);
}

Batch::~Batch() = default;

BatchSummary Batch::run(const std::vector<BatchJob>& jobs, const BatchOptions& options,
                        const Context& context) {
  if (!impl_->server) throw InputError("a batch runs once");
  check(jobs, options);
  return littoral::run(context, [&](const Task& task) {
    return RunningBatch(impl_->server, jobs, options, task).run();
  });
}

}  // namespace littoral
