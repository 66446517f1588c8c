// SPDX-License-Identifier: GPL-3.0-or-later
#include "scheme_conversions.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace py = pybind11;

namespace reachcast::bindings {
namespace {

constexpr const char* kKeys = "k, ranks or distances, weights, mirrored, sets, paths, postures, smoother, bandwidth, ridge";

[[noreturn]] void refuse(const std::string& key, const py::handle& value, const std::string& limit) {
  throw std::invalid_argument("scheme: " + key + " is " + py::repr(value).cast<std::string>() + "; it must be " +
                              limit);
}

bool is_number(const py::handle& value) {
  return (py::isinstance<py::float_>(value) || py::isinstance<py::int_>(value)) && !py::isinstance<py::bool_>(value);
}

int to_k(const py::handle& value) {
  if (!py::isinstance<py::int_>(value) || py::isinstance<py::bool_>(value)) refuse("k", value, "a whole number");
  int overflow = 0;
  const long long k = PyLong_AsLongLongAndOverflow(value.ptr(), &overflow);
  if (overflow != 0 || k < 1 || k > std::numeric_limits<int>::max()) refuse("k", value, "1 to 2147483647");
  return static_cast<int>(k);
}

double to_number(const std::string& key, const py::handle& value) {
  if (!is_number(value) || !std::isfinite(value.cast<double>())) refuse(key, value, "a finite number");
  return value.cast<double>();
}

std::size_t to_choice(const std::string& key, const py::handle& value, std::initializer_list<const char*> choices) {
  std::string listed;
  std::size_t number = 0;
  for (const char* choice : choices) {
    if (py::isinstance<py::str>(value) && value.cast<std::string>() == choice) return number;
    listed += std::string(number++ == 0 ? "'" : " or '") + choice + "'";
  }
  refuse(key, value, listed);
}

/// Marks one thing as compared; `scale`: what counts as 1 in its distances, or None for the corpus's own spread.
void add_criterion(Scheme& scheme, const std::string& key, const py::handle& name, const py::handle& scale) {
  double* wanted = nullptr;
  bool is_new = false;
  const std::string text = py::isinstance<py::str>(name) ? name.cast<std::string>() : std::string();
  if (text == "task") {
    is_new = !std::exchange(scheme.task, true);
    wanted = &scheme.task_scale_m;
  }
  for (std::size_t t = 0; t < kTraitCount && wanted == nullptr; ++t) {
    if (text != trait_name(static_cast<Trait>(t))) continue;
    is_new = !std::exchange(scheme.traits[t], true);
    wanted = &scheme.trait_scales[t];
  }
  if (wanted == nullptr) refuse("an entry of " + key, name, "'task', 'stature', 'age', 'sex', 'mass' or 'duration'");
  if (!is_new) refuse("an entry of " + key, name, "named once");
  if (scale.is_none()) return;
  *wanted = to_number("the scale of " + text, scale);
  if (!(*wanted > 0.0)) refuse("the scale of " + text, scale, "over 0");
}

void set_criteria(Scheme& scheme, const std::string& key, const py::handle& value) {
  scheme.measure = key == "ranks" ? Measure::ranks : Measure::distances;
  scheme.task = false;
  scheme.traits = {};
  if (key == "distances" && py::isinstance<py::dict>(value)) {
    for (const auto& [name, scale] : py::reinterpret_borrow<py::dict>(value)) add_criterion(scheme, key, name, scale);
  } else if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    for (const py::handle name : value) add_criterion(scheme, key, name, py::none());
  } else {
    refuse(key, value, key == "ranks" ? "a list of names" : "a list of names, or a dict of scales by name");
  }
}

void set(Scheme& scheme, const std::string& key, const py::handle& value) {
  if (key == "k") {
    scheme.k = to_k(value);
  } else if (key == "ranks" || key == "distances") {
    set_criteria(scheme, key, value);
  } else if (key == "weights") {
    scheme.smoother = to_choice(key, value, {"uniform", "triangular"}) == 0 ? Smoother::uniform : Smoother::triangular;
  } else if (key == "mirrored") {
    if (!py::isinstance<py::bool_>(value)) refuse(key, value, "True or False");
    scheme.mirrored = value.cast<bool>();
  } else if (key == "sets") {
    if (!is_number(value) || (value.cast<double>() != 1.0 && value.cast<double>() != 2.0)) refuse(key, value, "1 or 2");
    scheme.sets = value.cast<double>() == 1.0 ? Sets::one : Sets::two;
  } else if (key == "paths") {
    scheme.paths = to_choice(key, value, {"deviation", "bezier"}) == 0 ? PathForm::deviation : PathForm::bezier;
  } else if (key == "postures") {
    scheme.postures = to_choice(key, value, {"coordinates", "poses"}) == 0 ? Average::coordinates : Average::poses;
  } else if (key == "smoother") {
    const std::size_t choice = to_choice(key, value, {"mean", "kernel", "linear"});
    if (choice != 0) scheme.smoother = choice == 1 ? Smoother::kernel : Smoother::linear;
  } else if (key == "bandwidth") {
    scheme.bandwidth = to_number(key, value);
  } else if (key == "ridge") {
    scheme.ridge = to_number(key, value);
  } else {
    throw std::invalid_argument("scheme: unknown key '" + key + "'; known are " + kKeys);
  }
}

/// A value that would have no effect is a mistake too.
void require_used(const py::dict& given, const Scheme& scheme) {
  const bool kernel = scheme.smoother == Smoother::kernel || scheme.smoother == Smoother::linear;
  const auto refuse_key = [&](const char* key, bool is_used, const char* reason) {
    if (given.contains(key) && !is_used) throw std::invalid_argument("scheme: '" + std::string(key) + "' " + reason);
  };
  refuse_key("ranks", !given.contains("distances"), "and 'distances' are given; one of them must do");
  refuse_key("weights", !kernel, "belongs to the smoother 'mean'");
  refuse_key("bandwidth", kernel, "belongs to the smoothers 'kernel' and 'linear'");
  refuse_key("ridge", scheme.smoother == Smoother::linear, "belongs to the smoother 'linear'");
}

/// A list of names, or scales by name where any is given.
py::object criteria(const Scheme& scheme) {
  py::list names;
  py::dict scales;
  bool has_scale = false;
  const auto add = [&](const std::string& name, double scale) {
    names.append(name);
    scales[py::str(name)] = scale > 0.0 ? py::object(py::float_(scale)) : py::object(py::none());
    has_scale |= scale > 0.0;
  };
  if (scheme.task) add("task", scheme.task_scale_m);
  for (std::size_t t = 0; t < kTraitCount; ++t) {
    if (scheme.traits[t]) add(std::string(trait_name(static_cast<Trait>(t))), scheme.trait_scales[t]);
  }
  return has_scale ? py::object(scales) : py::object(names);
}

}  // namespace

Scheme to_scheme(const py::handle& given) {
  if (!py::isinstance<py::dict>(given)) {
    throw std::invalid_argument("a scheme is " + py::repr(given).cast<std::string>() +
                                "; it must be a dict such as {'k': 5}");
  }
  const auto dict = py::reinterpret_borrow<py::dict>(given);
  Scheme scheme;
  for (const char* order : {"smoother", "others"}) {  // the smoother decides what the weights can be
    for (const auto& [key, value] : dict) {
      if (!py::isinstance<py::str>(key)) refuse("a key", key, std::string("one of ") + kKeys);
      const bool is_smoother = key.cast<std::string>() == "smoother";
      if (is_smoother == (std::string(order) == "smoother")) set(scheme, key.cast<std::string>(), value);
    }
    if (std::string(order) == "smoother") require_used(dict, scheme);
  }
  check(scheme);
  return scheme;
}

py::dict scheme_dict(const Scheme& scheme) {
  const bool kernel = scheme.smoother == Smoother::kernel || scheme.smoother == Smoother::linear;
  py::dict out;
  out["k"] = scheme.k;
  out[scheme.measure == Measure::ranks ? "ranks" : "distances"] = criteria(scheme);
  out["smoother"] = !kernel ? "mean" : scheme.smoother == Smoother::kernel ? "kernel" : "linear";
  if (!kernel) out["weights"] = scheme.smoother == Smoother::uniform ? "uniform" : "triangular";
  if (kernel) out["bandwidth"] = scheme.bandwidth;
  if (scheme.smoother == Smoother::linear) out["ridge"] = scheme.ridge;
  out["mirrored"] = scheme.mirrored;
  out["sets"] = scheme.effective_sets() == Sets::one ? 1 : 2;
  out["paths"] = scheme.paths == PathForm::deviation ? "deviation" : "bezier";
  out["postures"] = scheme.postures == Average::coordinates ? "coordinates" : "poses";
  return out;
}

Scheme to_scheme(const std::optional<int>& k, const py::object& given) {
  Scheme scheme = given.is_none() ? Scheme{} : to_scheme(given);
  if (!k) return scheme;
  if (!given.is_none() && given.contains("k") && scheme.k != *k) {
    throw std::invalid_argument("k is " + std::to_string(*k) + " and the scheme's k is " + std::to_string(scheme.k) +
                                "; give one of them");
  }
  scheme.k = *k;
  return scheme;
}

void refuse_unknown(const py::kwargs& unknown, const char* function, const char* known) {
  if (unknown.empty()) return;
  throw std::invalid_argument(std::string(function) + ": unknown option " +
                              py::repr((*unknown.begin()).first).cast<std::string>() + "; known are " + known);
}

}  // namespace reachcast::bindings
