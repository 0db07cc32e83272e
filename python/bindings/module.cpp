// The extension module: errors, settings, methods, reports; the rest is in the files beside it.

#include "api/report_json.h"
#include "bindings.h"

namespace littoral::python {

namespace {

/// Classes of littoral/_errors.py, so that they can derive from Python's own as well.
nb::object error_class(const char* name) {
  return nb::module_::import_("littoral._errors").attr(name);
}

nb::object error_object(const char* name, const Error& error) {
  nb::object instance = error_class(name)(shown_text(error.what()));
  instance.attr("code") = error.code();
  return instance;
}

void raise(const char* name, const nb::object& instance) {
  PyErr_SetObject(error_class(name).ptr(), instance.ptr());
}

void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const SolveError& error) {
    const nb::object instance = error_object("SolveError", error);
    instance.attr("residual") = error.residual();
    raise("SolveError", instance);
  } catch (const InputError& error) {
    raise("InputError", error_object("InputError", error));
  } catch (const UnsupportedError& error) {
    raise("UnsupportedError", error_object("UnsupportedError", error));
  } catch (const IoError& error) {
    raise("IoError", error_object("IoError", error));
  } catch (const Cancelled& error) {
    raise("Cancelled", error_object("Cancelled", error));
  } catch (const Error& error) {
    raise("Error", error_object("Error", error));
  }
}

template <class T>
nb::object as_python(const T& value) {
  return nb::cast(value);
}
nb::object as_python(const std::string& text) { return shown_text(text); }
template <class Value>
nb::object as_python(const std::vector<std::pair<std::string, Value>>& entries) {
  nb::dict out;
  for (const auto& [name, value] : entries) out[name.c_str()] = as_python(value);
  return out;
}

template <class T>
void read_into(T& value, const nb::handle& data) {
  value = nb::cast<T>(data);
}
template <class Value>
void read_into(std::vector<std::pair<std::string, Value>>& entries, const nb::handle& data) {
  for (const auto& [name, value] : nb::cast<nb::dict>(data))
    entries.emplace_back(nb::cast<std::string>(name), nb::cast<Value>(value));
}

nb::object as_python(const std::vector<Warning>& warnings) {
  const nb::object type = nb::module_::import_("littoral._report").attr("ReportWarning");
  nb::list out;
  for (const auto& [code, text] : warnings) out.append(type(shown_text(text), code));
  return out;
}
void read_into(std::vector<Warning>& warnings, const nb::handle& data) {
  for (const nb::handle each : data)
    warnings.push_back({nb::cast<std::string>(each.attr("code")), nb::cast<std::string>(each)});
}

nb::dict as_dict(const OptionInfo& option) {
  nb::dict out;
  out["name"] = option.name;
  out["unit"] = option.unit;
  out["range"] = option.range();
  out["choices"] = option.choices;
  out["default"] = option.fallback;
  out["help"] = option.help;
  out["kind"] = option.kind_name();
  return out;
}

nb::list families() {
  nb::list out;
  for (const MethodFamily& family : method_families()) {
    nb::list methods;
    for (const MethodInfo& method : family.methods) {
      nb::dict entry;
      entry["name"] = method.name;
      entry["summary"] = method.summary;
      entry["domains"] = method.domains;
      entry["reference"] = method.reference;
      nb::list options;
      for (const OptionInfo& option : method.options) options.append(as_dict(option));
      entry["options"] = options;
      methods.append(entry);
    }
    out.append(nb::make_tuple(family.title, methods));
  }
  return out;
}

nb::str decoded(std::string_view text, const char* errors) {
  PyObject* out = PyUnicode_DecodeUTF8(text.data(), std::ssize(text), errors);
  if (out == nullptr) nb::raise_python_error();
  return nb::steal<nb::str>(out);
}

}  // namespace

nb::str shown_text(std::string_view text) { return decoded(text, "backslashreplace"); }
nb::str name_out(std::string_view name) { return decoded(name, "surrogateescape"); }

std::string name_in(nb::handle name) {
  PyObject* out = PyUnicode_AsEncodedString(name.ptr(), "utf-8", "surrogateescape");
  if (out == nullptr) nb::raise_python_error();
  const auto bytes = nb::steal<nb::bytes>(out);
  return {bytes.c_str(), bytes.size()};
}

nb::dict as_dict(const Report& report) {
  nb::dict out;
  const Report once = summed_up(report);
  each_entry(once, [&](const char* name, const auto& value) { out[name] = as_python(value); });
  return out;
}

Report as_report(const nb::dict& data) {
  Report report;
  each_entry(report, [&](const char* name, auto& value) { read_into(value, data[name]); });
  return report;
}

nb::tuple as_tuple(PolygonSoup soup) {
  nb::dict scalars;
  for (auto& [name, values] : soup.scalars) scalars[name_out(name)] = nb::cast(std::move(values));
  const auto integers = [](const std::vector<int>& values) {
    return nb::cast(VecXi(Eigen::Map<const VecXi>(values.data(), std::ssize(values))));
  };
  return nb::make_tuple(nb::cast(std::move(soup.points)), integers(soup.face_offsets),
                        integers(soup.corners), soup.lines, nb::cast(std::move(soup.normals)),
                        scalars);
}

PolygonSoup as_soup(const nb::tuple& data) {
  PolygonSoup soup;
  const auto integers = [](const nb::handle& array) {
    const auto values = nb::cast<VecXi>(array);
    return std::vector<int>(values.begin(), values.end());
  };
  soup.points = nb::cast<MatX3>(data[0]);
  soup.face_offsets = integers(data[1]);
  soup.corners = integers(data[2]);
  soup.lines = nb::cast<std::vector<std::vector<int>>>(data[3]);
  soup.normals = nb::cast<MatX3>(data[4]);
  for (const auto& [name, values] : nb::cast<nb::dict>(data[5]))
    soup.scalars[name_in(name)] = nb::cast<VecX>(values);
  return soup;
}

}  // namespace littoral::python

NB_MODULE(_core, m) {
  using namespace littoral::python;  // NOLINT: the module's only scope
  m.doc() = "The library itself; use the package littoral.";
  nb::register_exception_translator(translate);
  nb::class_<Settings>(m, "Settings")
      .def(
          "__init__",
          [](Settings* self, int threads, nb::object progress, double memory_limit) {
            new (self) Settings{threads, std::move(progress), memory_limit};
          },
          nb::arg("threads") = 0, nb::arg("progress") = nb::none(), nb::arg("memory_limit") = 0.0);
  m.def("method_families", families);
  bind_surfaces(m);
  bind_space(m);
  bind_tets(m);
  bind_operators(m);
  bind_batch(m);
  bind_samples(m);
}
