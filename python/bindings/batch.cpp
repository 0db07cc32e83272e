// Batches of calls of Python functions, in processes forked from this interpreter.

#include "api/batch/batch_status.h"
#include "bindings.h"

namespace littoral::python {

namespace {

/// input, name, options
using JobTuple = std::tuple<std::string, std::string, std::vector<std::string>>;

/// The outcome of `run`, called with the lock held: this interpreter is a copy with one thread.
BatchOutcome run_function(const nb::callable& run, const BatchJob& job,
                          const std::filesystem::path& folder) {
  const auto [status, message, report] =
      nb::cast<std::tuple<std::string, std::string, std::string>>(
          run(job.input, job.name, folder.string()));
  return {status, message, report};
}

std::string hash_of(const nb::callable& hash, const BatchJob& job,
                    const std::filesystem::path& folder) {
  try {
    return nb::cast<std::string>(hash(job.input, folder.string()));
  } catch (nb::python_error& error) {
    const std::string said = nb::cast<std::string>(nb::str(error.value()));
    const nb::object bad_input = nb::module_::import_("littoral._errors").attr("InputError");
    if (error.matches(bad_input)) throw InputError(said);
    if (error.matches(PyExc_OSError)) throw IoError(said);
    throw;
  }
}

nb::dict as_dict(const BatchSummary& summary) {
  nb::dict out;
  out["jobs"] = summary.jobs;
  out["done"] = summary.done;
  out["unchanged"] = summary.unchanged;
  out["failed"] = summary.failed;
  out["seconds"] = summary.seconds;
  out["start_seconds"] = summary.start_seconds;
  out["peak_memory"] = summary.peak_memory;
  nb::list failures;
  for (const BatchFailures& each : summary.failures)
    failures.append(nb::make_tuple(each.status, each.message, each.example, each.count));
  out["failures"] = failures;
  return out;
}

/// `run` and `hash` are called in processes of their own; `run` must not raise.
nb::dict batch(const std::vector<JobTuple>& jobs, const nb::callable& run, const nb::callable& hash,
               const std::string& folder, const nb::dict& how, const Settings* settings) {
  BatchOptions options;
  options.folder = folder;
  options.shard = nb::cast<int>(how["shard"]);
  options.shards = nb::cast<int>(how["shards"]);
  options.resume = nb::cast<bool>(how["resume"]);
  options.retries = nb::cast<int>(how["retries"]);
  options.fail_fast = nb::cast<bool>(how["fail_fast"]);
  options.processes = nb::cast<int>(how["processes"]);
  options.time_limit = nb::cast<double>(how["time_limit"]);
  options.memory_limit = nb::cast<double>(how["memory_limit"]);
  std::vector<BatchJob> list;
  for (const auto& [input, name, words] : jobs) list.push_back({input, name, words});
  Batch forked({[&run](const BatchJob& job, const std::filesystem::path& where) {
                  return run_function(run, job, where);
                },
                [&hash](const BatchJob& job, const std::filesystem::path& where) {
                  return hash_of(hash, job, where);
                },
                [] { PyOS_BeforeFork(); }, [] { PyOS_AfterFork_Parent(); },
                [] { PyOS_AfterFork_Child(); }});
  return as_dict(released(
      settings, [&](const Context& context) { return forked.run(list, options, context); }));
}

}  // namespace

void bind_batch(nb::module_& m) {
  m.def("batch", batch, nb::arg("jobs"), nb::arg("run"), nb::arg("hash"), nb::arg("folder"),
        nb::arg("how"), nb::arg("settings").none());
  m.def("batch_status_file", status_file_name, nb::arg("shard"), nb::arg("shards"));
  m.def(
      "is_batch_status_file", [](const std::string& name) { return is_status_file(name); },
      nb::arg("name"));
}

}  // namespace littoral::python
