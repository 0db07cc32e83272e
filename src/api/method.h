#pragma once
// What a method is: prepared once for a domain and its options, then solved for any sources. One
// template and one registry serve surfaces, tets, space, all pairs and regions.
//
// A domain D is a small struct of shared, immutable data with
//   D::Sources, D::Answer            what a solve is given and what it returns
//   D::title                         "Distance on surfaces"
//   kind()                           "triangle mesh", as in MethodInfo::domains
// and library_methods<D>() lists the methods that come with the library, the default first.

#include <any>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/option_table.h"
#include "base/task.h"
#include "littoral/error.h"
#include "littoral/methods.h"
#include "littoral/options.h"
#include "littoral/report.h"
#include "solve/heat/heat_system.h"

namespace littoral {

/// How many sets of sources a solver takes at once, and what memory that takes [bytes].
struct AtOnce {
  std::size_t sources = 1;
  double bytes = 0;
};

/// A method prepared for one domain. Immutable to its users: `solve` may be called from several
/// threads.
template <class D>
class Solver {
 public:
  using Sources = typename D::Sources;
  using Answers = std::vector<std::optional<typename D::Answer>>;

  virtual ~Solver() = default;
  /// Reports options with the values used, sizes, seconds per stage, iterations and residuals.
  virtual typename D::Answer solve(const Sources& sources, Task task, Report& report) const = 0;

  /// What a call of solve_together may be given; solvers that gain nothing by it have 1.
  virtual AtOnce at_once() const { return {}; }
  /// What `solve` says of each of several sets of sources, to rounding, or nothing where it must be
  /// asked; but seconds, which nobody has alone. The task is asked only whether to stop. Not for
  /// solvers that take one at once.
  virtual Answers solve_together(std::span<const Sources>, const Task&, std::span<Report>) const {
    return {};
  }
};

/// One method for domains of one type.
template <class D>
struct Method {
  MethodInfo info;
  /// The typed options; throws InputError for unknown ones and values out of range.
  std::function<std::any(const AnyMethod&)> options;
  /// Does all that does not depend on the sources. The hint says whether many solves are expected.
  std::function<std::shared_ptr<const Solver<D>>(const D& domain, const std::any& options,
                                                 SolveHint hint, Task task, Report& report)>
      prepare;
};

/// Throws InputError naming the option and the method, and what the method has, unless it has the
/// option.
void check_has_option(const MethodInfo& method, const std::string& option);

/// The options of a choice as struct S, checked against its table.
template <class S>
S typed_options(const MethodInfo& info, const OptionTable<S>& table, const AnyMethod& choice) {
  S options;
  if (choice.options().has_value()) {
    const S* given = std::any_cast<S>(&choice.options());
    if (!given)
      throw InputError("method " + info.name + " does not take options of this type here",
                       "option-value");
    options = *given;
  }
  for (const auto& [name, text] : choice.values()) {
    check_has_option(info, name);
    table.set(options, name, text);
  }
  table.check(options);
  return options;
}

/// Puts all options with the values used into the report.
template <class S>
void report_options(const OptionTable<S>& table, const S& options, Report& report) {
  for (std::size_t i = 0; i < table.infos().size(); ++i)
    report.options.emplace_back(table.infos()[i].name, table.get(options, i));
}

/// What a prepared method with options S does: one set of sources and, where that helps, several at
/// once. Both are const, for several threads, and may change their options to the values used.
template <class D, class S>
struct Solves {
  std::function<typename D::Answer(const typename D::Sources&, S&, Task&, Report&)> one;
  AtOnce at_once{};
  std::function<typename Solver<D>::Answers(std::span<const typename D::Sources>, std::span<S>,
                                            const Task&, std::span<Report>)>
      together{};
};

/// A method from a table of options S and `prepare(domain, options, hint, task, report)`, which
/// returns what solves: Solves<D, S>, or a callable for one set of sources.
template <class D, class S, class Prepare>
Method<D> make_method(MethodInfo info, const OptionTable<S>& table, Prepare prepare) {
  class Prepared final : public Solver<D> {
   public:
    Prepared(std::string name, std::string kind, const OptionTable<S>& options_table, S options,
             Solves<D, S> solves)
        : name_(std::move(name)),
          kind_(std::move(kind)),
          table_(options_table),
          options_(std::move(options)),
          solves_(std::move(solves)) {}
    typename D::Answer solve(const typename D::Sources& sources, Task task,
                             Report& report) const override {
      report.method = name_;
      report.domain = kind_;
      S used = options_;
      auto answer = solves_.one(sources, used, task, report);
      report_options(table_, used, report);
      return answer;
    }
    AtOnce at_once() const override { return solves_.at_once; }
    typename Solver<D>::Answers solve_together(std::span<const typename D::Sources> sources,
                                               const Task& task,
                                               std::span<Report> reports) const override {
      std::vector<S> used(sources.size(), options_);
      auto answers = solves_.together(sources, used, task, reports);
      for (std::size_t i = 0; i < reports.size(); ++i) {
        reports[i].method = name_;
        reports[i].domain = kind_;
        report_options(table_, used[i], reports[i]);
      }
      return answers;
    }

   private:
    std::string name_, kind_;
    const OptionTable<S>& table_;
    S options_;
    Solves<D, S> solves_;
  };
  info.options = table.infos();
  Method<D> method;
  method.options = [info, &table](const AnyMethod& choice) -> std::any {
    return typed_options(info, table, choice);
  };
  method.prepare = [name = info.name, &table, prepare](
                       const D& domain, const std::any& any, SolveHint hint, Task task,
                       Report& report) -> std::shared_ptr<const Solver<D>> {
    const S& options = std::any_cast<const S&>(any);
    auto made = prepare(domain, options, hint, task, report);
    Solves<D, S> solves;
    if constexpr (std::is_same_v<decltype(made), Solves<D, S>>)
      solves = std::move(made);
    else
      solves.one = std::move(made);
    return std::make_shared<const Prepared>(name, domain.kind(), table, options, std::move(solves));
  };
  method.info = std::move(info);
  return method;
}

/// The methods that come with the library, the default first.
template <class D>
std::vector<Method<D>> library_methods();

/// What a domain adds to all methods, whatever they know of it: nothing, unless it says so.
template <class D>
std::shared_ptr<const Solver<D>> with_additions(const MethodInfo&, const D&,
                                                std::shared_ptr<const Solver<D>> solver) {
  return solver;
}

/// All methods for domains of one type.
template <class D>
class Registry {
 public:
  static Registry& instance() {
    static Registry all;
    return all;
  }

  /// Adds a method of one's own: from then on it is found by name everywhere. Throws InputError if
  /// there is one of that name.
  void add(Method<D> method) {
    const std::lock_guard lock(mutex_);
    for (const auto& known : methods_)
      if (known->info.name == method.info.name)
        throw InputError("there is a method " + method.info.name + " already");
    methods_.push_back(std::make_shared<const Method<D>>(std::move(method)));
  }

  std::vector<std::shared_ptr<const Method<D>>> all() const {
    const std::lock_guard lock(mutex_);
    return methods_;
  }
  std::vector<MethodInfo> infos() const {
    std::vector<MethodInfo> out;
    for (const auto& method : all()) out.push_back(method->info);
    return out;
  }
  bool has(const std::string& name) const {
    for (const auto& method : all())
      if (method->info.name == name) return true;
    return false;
  }
  /// Throws InputError listing the known ones.
  std::shared_ptr<const Method<D>> find(const std::string& name) const {
    for (const auto& method : all())
      if (method->info.name == name) return method;
    throw InputError("unknown method '" + name + "'" + instead_of(name, infos()), "unknown-name");
  }

 private:
  Registry() {
    for (Method<D>& method : library_methods<D>())
      methods_.push_back(std::make_shared<const Method<D>>(std::move(method)));
  }
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<const Method<D>>> methods_;
};

/// Throws UnsupportedError, saying what would work, unless the method runs on such a domain.
void check_domain(const MethodInfo& method, const std::string& kind,
                  const std::vector<MethodInfo>& all);

/// For a method that measures from one value and is given several: throws UnsupportedError, naming
/// those that take them on such a domain.
[[noreturn]] void refuse_different_values(const MethodInfo& method, const std::string& kind,
                                          const std::vector<MethodInfo>& all);

/// Throws InputError, naming the methods that have it, where a choice without a name gives an
/// option that the default has not.
void check_options_of_default(const MethodInfo& fallback, const AnyMethod& choice,
                              const std::vector<MethodInfo>& all);

/// The method of the choice's name or, where it names none, the first that the library has.
template <class D>
std::shared_ptr<const Method<D>> chosen_method(const AnyMethod& choice) {
  if (!choice.name().empty()) return Registry<D>::instance().find(choice.name());
  const auto all = Registry<D>::instance().all();
  check_options_of_default(all.front()->info, choice, Registry<D>::instance().infos());
  return all.front();
}

/// Throws InputError if there is no such method, it lacks an option, or a value is out of range.
template <class D>
void check_method(const AnyMethod& choice) {
  if (!choice.name().empty()) Registry<D>::instance().find(choice.name())->options(choice);
}

/// Prepares the chosen method or, where the choice names none, the first that the library has.
/// Throws InputError and UnsupportedError before anything is computed.
template <class D>
std::shared_ptr<const Solver<D>> prepare(const AnyMethod& choice, const D& domain, SolveHint hint,
                                         const Task& task, Report& report) {
  const auto method = chosen_method<D>(choice);
  const std::any options = method->options(choice);
  report.method = method->info.name;
  report.domain = domain.kind();
  check_domain(method->info, report.domain, Registry<D>::instance().infos());
  return with_additions<D>(method->info, domain,
                           method->prepare(domain, options, hint, task, report));
}

/// Both in a row.
template <class D>
typename D::Answer solve_once(const AnyMethod& choice, const D& domain,
                              const typename D::Sources& sources, Task task, Report& report) {
  const auto solver =
      prepare(choice, domain, SolveHint::single_rhs, task.stage(0.4, "preparing"), report);
  return solver->solve(sources, task.stage(0.6, "solving"), report);
}

}  // namespace littoral
