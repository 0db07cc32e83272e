#include "api/report_json.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/index.h"
#include "base/parallel_sum.h"
#include "base/platform/memory.h"

namespace littoral {

namespace {

using Json = nlohmann::ordered_json;

std::string dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

Json number(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  if (std::abs(value) < 1e15 && value == std::floor(value)) return static_cast<std::int64_t>(value);
  return value;
}

/// An option's value: a number or a switch where its text is one.
Json option_value(const std::string& text) {
  if (text == "on" || text == "off") return text == "on";
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code == std::errc() && end == text.data() + text.size()) return number(value);
  return text;
}

/// Every name once, where it was first; `join(known, value)` is what becomes of two values.
template <class Join>
void unite(std::vector<std::pair<std::string, double>>& list, const Join& join) {
  std::vector<std::pair<std::string, double>> once;
  for (const auto& [name, value] : list) {
    const auto it = std::ranges::find(once, name, &std::pair<std::string, double>::first);
    if (it == once.end())
      once.emplace_back(name, value);
    else
      it->second = join(it->second, value);
  }
  list = std::move(once);
}

struct EntryJson {
  template <class T>
  Json operator()(const T& value) const {
    return value;
  }
  Json operator()(const std::vector<std::pair<std::string, std::string>>& options) const {
    Json out = Json::object();
    for (const auto& [name, text] : options) out[name] = option_value(text);
    return out;
  }
  Json operator()(const std::vector<std::pair<std::string, double>>& numbers) const {
    Json out = Json::object();
    for (const auto& [name, value] : numbers) out[name] = number(value);
    return out;
  }
  Json operator()(const std::vector<Warning>& warnings) const {
    Json out = Json::array();
    for (const auto& [code, text] : warnings) out.push_back({{"code", code}, {"message", text}});
    return out;
  }
};

struct InfoValueJson {
  Json operator()(bool value) const { return value; }
  Json operator()(double value) const { return number(value); }
  Json operator()(const std::string& value) const { return value; }
  Json operator()(const std::vector<double>& values) const {
    Json out = Json::array();
    for (double value : values) out.push_back(number(value));
    return out;
  }
  Json operator()(const std::vector<std::pair<std::string, std::vector<double>>>& named) const {
    Json out = Json::object();
    for (const auto& [name, values] : named) out[name] = (*this)(values);
    return out;
  }
};

}  // namespace

Report summed_up(Report report) {
  const auto last = [](double, double value) { return value; };
  const auto largest = [](double known, double value) {
    return std::isnan(value) || value > known ? value : known;
  };
  unite(report.sizes, last);
  unite(report.timings, std::plus());
  unite(report.iterations, std::plus());
  unite(report.residuals, largest);
  return report;
}

namespace {

void add_report(Json& out, const Report& report) {
  const Report once = summed_up(report);
  each_entry(once, [&](const char* name, const auto& value) { out[name] = EntryJson{}(value); });
  out["peak_memory_mb"] = std::round(peak_memory() / (1 << 20));
}

void add_run(Json& out, const RunRecord& record) {
  out["schema"] = "littoral-report-1";
  out["program"] = {{"name", "littoral"}, {"version", record.version}};
  out["verb"] = record.verb;
  out["inputs"] = record.inputs;
  out["outputs"] = record.outputs;
}

Json triple(const Vec3& x) { return {number(x[0]), number(x[1]), number(x[2])}; }

}  // namespace

std::string report_json(const Report& report) {
  Json out;
  add_report(out, report);
  return dump(out);
}

FieldRange range_of(std::string name, const Eigen::Ref<const VecX>& values) {
  constexpr std::size_t grain = std::size_t(1) << 18;
  const double infinity = std::numeric_limits<double>::infinity();
  struct Part {
    double low, high;
    std::size_t not_finite;
  };
  const auto n = std::size_t(values.size());
  const auto found = [&](std::size_t begin, std::size_t end) {
    Part part{infinity, -infinity, 0};
    for (std::size_t i = begin; i < end; ++i) {
      const double value = values[index(i)];
      if (!std::isfinite(value)) {
        ++part.not_finite;
        continue;
      }
      part.low = std::min(part.low, value);
      part.high = std::max(part.high, value);
    }
    return part;
  };
  const Part all =
      of_pieces(n, grain, Part{infinity, -infinity, 0}, found, [](const Part& a, const Part& b) {
        return Part{std::min(a.low, b.low), std::max(a.high, b.high), a.not_finite + b.not_finite};
      });
  const double none = std::numeric_limits<double>::quiet_NaN();
  FieldRange range{std::move(name), none, none, n, all.not_finite};
  if (all.low <= all.high) {
    range.low = all.low;
    range.high = all.high;
  }
  return range;
}

std::string run_json(const RunRecord& record, const Report& report) {
  Json out;
  add_run(out, record);
  add_report(out, report);
  if (record.grid)
    out["grid"] = {{"origin", triple(record.grid->origin)},
                   {"spacing", triple(record.grid->spacing)},
                   {"shape", record.grid->n},
                   {"axis_order", "array[i, j, k] is at origin + (i, j, k) * spacing"}};
  if (record.plan) {
    const PlannedRun& plan = *record.plan;
    Json& planned =
        out["plan"] = {{"reason", plan.reason}, {"available_memory_mb", plan.available_memory_mb}};
    for (const auto& [name, value] : {std::pair("seconds", plan.seconds),
                                      {"processor_seconds", plan.processor_seconds},
                                      {"memory_mb", plan.memory_mb}})
      if (value) planned[name] = *value;
  }
  out["values"] = Json::object();
  for (const FieldRange& range : record.values)
    out["values"][range.name] = {{"min", number(range.low)},
                                 {"max", number(range.high)},
                                 {"count", range.count},
                                 {"not_finite", range.not_finite}};
  return dump(out);
}

std::string failure_json(const RunRecord& record, const Report& report, const RunFailure& failure) {
  Json out;
  add_run(out, record);
  out["status"] = "failed";
  out["error"] = {{"kind", failure.kind},
                  {"code", failure.code},
                  {"message", failure.message},
                  {"exit_status", failure.exit_status}};
  out["warnings"] = EntryJson{}(report.warnings);
  return dump(out);
}

std::string info_json(const std::vector<InfoEntry>& entries) {
  Json out = Json::object();
  for (const InfoEntry& entry : entries) out[entry.key] = std::visit(InfoValueJson{}, entry.value);
  return dump(out);
}

namespace {

Json option_json(const OptionInfo& info) {
  Json out{{"name", info.name},
           {"kind", info.kind_name()},
           {"unit", info.unit},
           {"range", info.range()},
           {"default", option_value(info.fallback)},
           {"help", info.help}};
  if (info.kind == OptionInfo::Kind::number || info.kind == OptionInfo::Kind::integer) {
    out["low"] = number(info.low);
    out["high"] = number(info.high);
  }
  if (info.kind == OptionInfo::Kind::choice) out["choices"] = info.choices;
  return out;
}

}  // namespace

std::string methods_json(const std::vector<MethodFamily>& families) {
  Json out = Json::array();
  for (const MethodFamily& family : families)
    for (const MethodInfo& method : family.methods) {
      Json options = Json::array();
      for (const OptionInfo& info : method.options) options.push_back(option_json(info));
      out.push_back({{"name", method.name},
                     {"for", family.title},
                     {"summary", method.summary},
                     {"domains", method.domains},
                     {"options", options},
                     {"reference", method.reference}});
    }
  return dump(out);
}

}  // namespace littoral
