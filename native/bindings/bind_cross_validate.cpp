// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "module.hpp"
#include "reachcast/predict/cross_validate.hpp"
#include "scheme_conversions.hpp"

namespace py = pybind11;
using namespace reachcast;
using namespace reachcast::bindings;

namespace {

LeaveOut to_leave_out(const std::string& name) {
  if (name == "motion") return LeaveOut::motion;
  if (name == "subject") return LeaveOut::subject;
  throw std::invalid_argument("leave_out is '" + name + "'; it must be 'motion' or 'subject'");
}

void add_summary(const ErrorSummary& error, py::dict& row) {
  row["median"] = error.median_m;
  row["quartiles"] = py::make_tuple(error.lower_quartile_m, error.upper_quartile_m);
  row["interval"] = py::make_tuple(error.median_interval_m.low, error.median_interval_m.high);
  row["groups"] = error.groups;
}

py::list table(const Corpus& corpus, const py::iterable& schemes, const std::string& leave_out, std::uint64_t seed,
               unsigned threads, const py::kwargs& unknown) {
  refuse_unknown(unknown, "cross_validate", "leave_out, seed, threads");
  std::vector<Scheme> wanted;
  for (const py::handle scheme : schemes) wanted.push_back(to_scheme(scheme));
  const CrossValidation options{.leave_out = to_leave_out(leave_out), .seed = seed, .threads = threads};
  std::vector<SchemeError> rows;
  {
    const py::gil_scoped_release without_gil;
    rows = cross_validate(corpus, wanted, options);
  }
  py::list out;
  for (const SchemeError& row : rows) {
    py::dict entry;
    entry["scheme"] = scheme_dict(row.scheme);
    entry["label"] = describe(row.scheme);
    entry["k"] = row.scheme.k;
    entry["motions"] = row.motions;
    entry["out_of_reach"] = row.out_of_reach;
    entry["failed"] = row.failed;
    add_summary(row.error, entry);
    entry["best"] = row.is_best;
    entry["behind_best"] = py::make_tuple(row.behind_best_m.low, row.behind_best_m.high);
    out.append(entry);
  }
  return out;
}

py::dict by_motion(const Corpus& corpus, const py::handle& scheme, const std::string& leave_out, unsigned threads,
                   const py::kwargs& unknown) {
  refuse_unknown(unknown, "left_out_errors", "scheme, leave_out, threads");
  const Scheme wanted = to_scheme(scheme);
  std::vector<LeftOutError> errors;
  const CrossValidation options{.leave_out = to_leave_out(leave_out), .threads = threads};
  {
    const py::gil_scoped_release without_gil;
    errors = left_out_errors(corpus, wanted, options);
  }
  py::dict out;
  for (const LeftOutError& error : errors) out[py::int_(error.motion_id)] = error.error_m;
  return out;
}

py::dict variation(const Corpus& corpus, double within, std::uint64_t seed, unsigned threads,
                   const py::kwargs& unknown) {
  refuse_unknown(unknown, "natural_variation", "within, seed, threads");
  NaturalVariation found;
  {
    const py::gil_scoped_release without_gil;
    found = natural_variation(corpus, within, seed, threads);
  }
  py::dict out;
  out["pairs"] = found.pairs;
  out["out_of_reach"] = found.out_of_reach;
  out["within"] = within;
  add_summary(found.error, out);
  if (found.pairs > 0) return out;
  for (const char* key : {"median", "quartiles", "interval"}) out[key] = py::none();
  return out;
}

py::list listed_schemes(const std::string& which) {
  if (which != "all" && which != "paper") {
    throw std::invalid_argument("schemes: '" + which + "' is unknown; it must be 'all' or 'paper'");
  }
  py::list out;
  for (const Scheme& scheme : which == "all" ? all_schemes() : paper_schemes()) out.append(scheme_dict(scheme));
  return out;
}

}  // namespace

void bind_cross_validate(py::module_& m) {
  m.def(
      "cross_validate", &table, py::arg("corpus"), py::arg("schemes"), py::arg("leave_out") = "motion", py::kw_only(),
      py::arg("seed") = kBootstrapSeed, py::arg("threads") = 0u,
      "How well transfers are predicted from the others: corpus, schemes -> list of dicts, one per scheme.\n\n"
      "A scheme is a dict; every key may be missing: k (5); ranks, a list of 'task', 'stature', 'age', 'sex', 'mass', "
      "'duration' (['task', 'stature']), or distances, the same or a dict of scales by name (None: the corpus's own "
      "spread); smoother 'mean' with weights 'triangular' or 'uniform', 'kernel' with bandwidth (0.5 scales), "
      "'linear' with bandwidth and ridge (0.1); mirrored (True); sets of neighbours, one for each end of the motion "
      "or one for all (2). leave_out: 'motion' (and its mirror image) or 'subject'.\n\n"
      "A row: scheme, label, k, motions, out_of_reach (not predicted: the recording itself does not fit a body of "
      "its stature), failed (predictions that cannot be held, counted as infinitely wrong); in metres the median over "
      "motions of the mean distance over time and 23 joints, its quartiles, and the 95 % interval of the median by "
      "1000 bootstrap resamples (seed) of groups (motions, or subjects where those are left out); best; and "
      "behind_best, the 95 % interval of how far "
      "its median lies above the best one's in the same resamples.");
  m.def(
      "left_out_errors", &by_motion, py::arg("corpus"), py::arg("scheme") = py::dict(),
      py::arg("leave_out") = "subject", py::kw_only(), py::arg("threads") = 0u,
      "What cross_validate takes the median of, for one scheme: dict from the id of every transfer that is no mirror "
      "image to its error in metres, infinite where the prediction cannot be held; motions out of reach are missing.");
  m.def(
      "natural_variation", &variation, py::arg("corpus"), py::arg("within") = 0.05, py::kw_only(),
      py::arg("seed") = kBootstrapSeed, py::arg("threads") = 0u,
      "How far one person's transfers with homes and targets `within` metres of one another are apart, on the measure "
      "of cross_validate: dict of pairs, median, quartiles, interval (metres; None without pairs), groups (subjects), "
      "out_of_reach, within.");
  m.def("schemes", &listed_schemes, py::arg("which") = "all",
        "Schemes for cross_validate: 'paper' for those that Faraway 2004 names on p. 549, 'all' for 60.");
}
