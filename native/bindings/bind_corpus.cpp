// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "array_checks.hpp"
#include "module.hpp"
#include "reachcast/corpus/corpus.hpp"
#include "reachcast/motion/encode.hpp"

namespace py = pybind11;
using namespace py::literals;

namespace {

using reachcast::Corpus;
using reachcast::MotionCode;
using reachcast::MotionSummary;
using reachcast::Reach;
using reachcast::SourceFile;
using reachcast::StoredSource;
using reachcast::Subject;
using reachcast::bindings::numbers_array;
using reachcast::bindings::vec3_array;
using ReleaseGil = py::call_guard<py::gil_scoped_release>;

/// Origins come from file names, which may hold any bytes.
py::str text(const std::string& bytes) {
  PyObject* const decoded = PyUnicode_DecodeUTF8(bytes.data(), static_cast<py::ssize_t>(bytes.size()), "replace");
  if (!decoded) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

/// The codes of reaches and, if wanted, of the mirror image of each after it.
std::vector<MotionCode> codes_of(const std::vector<Reach>& reaches, bool mirror) {
  std::vector<MotionCode> codes;
  codes.reserve(reaches.size() * (mirror ? 2 : 1));
  for (const Reach& reach : reaches) {
    codes.push_back(reachcast::encode_reach(reach));
    if (!mirror) continue;
    codes.push_back(reachcast::encode_reach(reachcast::mirrored(reach)));
    codes.back().is_mirrored = true;
  }
  return codes;
}

using RejectionTexts = std::vector<std::pair<std::string, std::string>>;

std::optional<StoredSource> add_source(Corpus& corpus, const std::string& path, const std::string& checksum,
                                       std::int64_t bytes, const std::vector<Reach>& reaches,
                                       const RejectionTexts& left_out, const std::string& note,
                                       const std::string& settings, bool mirror) {
  std::vector<reachcast::StoredRejection> rejections;
  for (const auto& [what, reason] : left_out) rejections.push_back({what, reason});
  const SourceFile file{path, checksum, bytes, "reachcast " REACHCAST_VERSION, note, settings};
  return corpus.add_source(file, codes_of(reaches, mirror), rejections);
}

std::optional<StoredSource> copy_source(Corpus& corpus, const StoredSource& source,
                                        const std::vector<MotionCode>& codes) {
  return corpus.add_source(source.file, codes, source.rejections);
}

std::vector<MotionCode> load(const Corpus& corpus, const std::vector<std::int64_t>& ids) {
  std::vector<MotionCode> codes;
  codes.reserve(ids.size());
  for (reachcast::StoredMotion& motion : corpus.load(ids)) codes.push_back(std::move(motion.code));
  return codes;
}

/// The fields that MotionCode and MotionSummary share.
template <typename Motion>
void bind_motion_fields(py::class_<Motion>& motion) {
  motion
      .def_property_readonly(
          "subject", [](const Motion& self) { return self.subject; }, "A copy.")
      .def_property_readonly(
          "phase", [](const Motion& self) { return std::string(reachcast::phase_name(self.phase)); },
          "\"transfer\", \"return\", \"reach\" or \"retrieve\".")
      .def_property_readonly(
          "hands", [](const Motion& self) { return std::string(reachcast::hands_name(self.hands)); },
          "The hands that work: \"both\", \"left\" or \"right\".")
      .def_property_readonly(
          "origin", [](const Motion& self) { return text(self.origin); }, "File and frames.")
      .def_readonly("mirrored", &Motion::is_mirrored, "True for the mirror image of the reach named by origin.")
      .def_readonly("duration", &Motion::duration_s, "Seconds.")
      .def_property_readonly(
          "home", [](const Motion& self) { return vec3_array(self.home); },
          "(3,) hold point at the start, body frame, metres; a copy.")
      .def_property_readonly(
          "target", [](const Motion& self) { return vec3_array(self.target); },
          "(3,) hold point at the end, body frame, metres; a copy.")
      .def_readonly("grip_distance", &Motion::grip_distance_m, "Metres between the grips at the start.");
}

std::string fields_text(const std::string& origin, reachcast::Phase phase, double duration_s, bool is_mirrored) {
  char duration[32];
  std::snprintf(duration, sizeof duration, "%.2f s", duration_s);
  return "'" + origin + "', " + std::string(reachcast::phase_name(phase)) + ", " + duration +
         (is_mirrored ? ", mirrored>" : ">");
}

std::string corpus_text(const Corpus& corpus) {
  const std::string start = "<Corpus '" + corpus.path().string() + "', ";
  if (!corpus.is_open()) return start + "closed>";
  const std::string kind = corpus.meta()["kind"];
  return start + std::to_string(corpus.size()) + " motions" + (kind.empty() ? "" : ", " + kind) +
         (corpus.is_writable() ? ", writable>" : ">");
}

void bind_motions(py::module_& m) {
  py::class_<MotionCode> code(m, "MotionCode", "What the corpus keeps of one reach: numbers that can be averaged.");
  bind_motion_fields(code);
  code.def_property_readonly(
          "coefficients", [](const MotionCode& self) { return numbers_array(self.coefficients); },
          "(n,) spline coefficients; a copy.")
      .def("__repr__", [](const MotionCode& self) {
        return text("<MotionCode " + fields_text(self.origin, self.phase, self.duration_s, self.is_mirrored));
      });
  py::class_<MotionSummary> summary(m, "MotionSummary", "A motion in a corpus, without its coefficients.");
  bind_motion_fields(summary);
  summary.def_readonly("id", &MotionSummary::id)
      .def_readonly("subject_id", &MotionSummary::subject_id, "Equal for motions of the same subject values.")
      .def("__repr__", [](const MotionSummary& self) {
        return text("<MotionSummary " + std::to_string(self.id) + ": " +
                    fields_text(self.origin, self.phase, self.duration_s, self.is_mirrored));
      });
}

void bind_opening(py::class_<Corpus>& corpus) {
  corpus
      .def_static(
          "create",
          [](const std::filesystem::path& path, const std::string& precision) {
            if (precision != "exact" && precision != "compact")
              throw std::invalid_argument("precision is '" + precision + "'; it must be 'exact' or 'compact'");
            return Corpus::create(path, "reachcast " REACHCAST_VERSION,
                                  precision == "exact" ? reachcast::Precision::exact : reachcast::Precision::compact);
          },
          "path"_a, "precision"_a = "exact", ReleaseGil(),
          "A new, empty corpus. precision: \"exact\", or \"compact\", in a fifth of the bytes and with an error of at "
          "most 1/8192 of a coefficient, some 0.04 mm of a joint's place. ValueError if something is at path already.")
      .def_static("open", &Corpus::open, "path"_a, ReleaseGil(),
                  "Read-only. ValueError for a file that is missing, empty, not a corpus or of a newer schema; "
                  "RuntimeError for a damaged file.")
      .def_static("open_for_writing", &Corpus::open_for_writing, "path"_a, ReleaseGil(),
                  "Reads and adds; also repairs what a crashed writer left half done.")
      .def("close", &Corpus::close, ReleaseGil(), "Releases the file; later calls raise ValueError.")
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](Corpus& self, const py::args&) { self.close(); })
      .def_property_readonly("path", &Corpus::path)
      .def("__repr__", [](const Corpus& self) {
        std::string description;
        {
          const py::gil_scoped_release release;
          description = corpus_text(self);
        }
        return text(description);
      });
}

void bind_stored_source(py::module_& m) {
  py::class_<StoredSource>(m, "StoredSource", "A file that was imported into a corpus.")
      .def_readonly("id", &StoredSource::id)
      .def_property_readonly(
          "path", [](const StoredSource& self) { return text(self.file.path); }, "As it was given.")
      .def_property_readonly(
          "checksum", [](const StoredSource& self) { return text(self.file.checksum); }, "Of its bytes.")
      .def_property_readonly("bytes", [](const StoredSource& self) { return self.file.bytes; })
      .def_property_readonly(
          "tool", [](const StoredSource& self) { return text(self.file.tool); }, "What read it, with version.")
      .def_property_readonly(
          "note", [](const StoredSource& self) { return text(self.file.note); }, "How it was understood.")
      .def_property_readonly(
          "settings", [](const StoredSource& self) { return text(self.file.settings); },
          "What else decided the result.")
      .def_readonly("motions", &StoredSource::motions, "How many came from it, mirror images included.")
      .def_property_readonly(
          "rejections",
          [](const StoredSource& self) {
            py::list pairs;
            for (const auto& left_out : self.rejections)
              pairs.append(py::make_tuple(text(left_out.what), text(left_out.reason)));
            return pairs;
          },
          "What did not become a motion: list of (what, reason).")
      .def("__repr__", [](const StoredSource& self) {
        return text("<StoredSource " + std::to_string(self.id) + ": '" + self.file.path + "', " +
                    std::to_string(self.motions) + " motions, " + std::to_string(self.rejections.size()) +
                    " rejected>");
      });
}

void bind_sources(py::class_<Corpus>& corpus) {
  corpus
      .def("add_source", &add_source, "path"_a, "checksum"_a, "bytes"_a, "reaches"_a, "rejections"_a, py::kw_only(),
           "note"_a = "", "settings"_a = "", "mirror"_a = true, ReleaseGil(),
           "What a file gave, all of it or nothing: reaches, encoded with their mirror images, and rejections as pairs "
           "of what and why. None where a file with this checksum and these settings is stored already; one stored "
           "with other settings is replaced.")
      .def("copy_source", &copy_source, "source"_a, "codes"_a, ReleaseGil(),
           "The same with a source of another corpus and the MotionCodes that came from it.")
      .def("sources", &Corpus::sources, ReleaseGil(), "All imported files in id order: list of StoredSource.")
      .def("has_source", &Corpus::has_source, "checksum"_a, "settings"_a, ReleaseGil(),
           "True where add_source would change nothing.")
      .def("motions_of", &Corpus::motions_of, "source_id"_a, ReleaseGil(), "Ids of the motions that came from a file.")
      .def(
          "remove", [](Corpus& self, const std::vector<std::int64_t>& ids) { return self.remove(ids); }, "ids"_a,
          ReleaseGil(),
          "Takes motions away and returns how many there were. A file goes with its last motion, so that it can be "
          "imported again; in a compact corpus mirror images go with their motion.")
      .def("check", &Corpus::check, ReleaseGil(),
           "Reads everything: list of what is wrong, a sentence each, at most 100; empty where nothing is.");
}

void bind_contents(py::class_<Corpus>& corpus) {
  corpus.def("__len__", &Corpus::size, ReleaseGil())
      .def(
          "__bool__", [](const Corpus&) { return true; }, "True, also when empty.")
      .def(
          "add",
          [](Corpus& self, const MotionCode& code) {
            return self.add({&code, 1}).front();
          },
          "code"_a, ReleaseGil(), "Stores one code and returns its id.")
      .def(
          "add", [](Corpus& self, const std::vector<MotionCode>& codes) { return self.add(codes); }, "codes"_a,
          ReleaseGil(),
          "Stores all of them or, on an error, none; returns one id per code. What is there already "
          "(same origin, mirrored and phase) stays as it is and yields its id.")
      .def(
          "add_reaches",
          [](Corpus& self, const std::vector<Reach>& reaches, bool mirror) {
            return self.add(codes_of(reaches, mirror));
          },
          "reaches"_a, py::kw_only(), "mirror"_a = true, ReleaseGil(),
          "Encodes and stores reaches and, with mirror, their mirror images after each; returns the ids.")
      .def(
          "motions", [](const Corpus& self) { return self.table()->motions(); }, ReleaseGil(),
          "All motions in id order: list of MotionSummary.")
      .def("load", &load, "ids"_a, ReleaseGil(), "The MotionCodes of these ids, in their order.")
      .def_property_readonly("meta", py::cpp_function(&Corpus::meta, ReleaseGil()),
                             "dict of str: schema_version, created_by, kind, description, code_length and your own; "
                             "a copy, see set_meta.")
      .def("set_meta", &Corpus::set_meta, "key"_a, "value"_a, ReleaseGil());
}

}  // namespace

void bind_corpus(py::module_& m) {
  bind_motions(m);
  py::class_<Corpus> corpus(m, "Corpus",
                            "Many motions in one SQLite file. Any number of programs may read while one writes. "
                            "Open it after a fork, not before.");
  bind_stored_source(m);
  bind_opening(corpus);
  bind_sources(corpus);
  bind_contents(corpus);
}
