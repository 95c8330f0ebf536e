#include "case/unused_entries.h"

#include <algorithm>
#include <vector>

namespace vibrissa::sensor_case {

namespace {

using enum CaseUse;
using Uses = std::vector<CaseUse>;

/// Entries whose path begins and ends so, and the commands that use them; the longest pattern
/// decides.
struct Users {
  std::string beginning;
  Uses uses;
  std::string ending = "";

  bool matches(const std::string& path) const {
    return path.starts_with(beginning) && path.ends_with(ending);
  }
  std::size_t length() const { return beginning.size() + ending.size(); }
};

const std::vector<Users>& users() {
  static const std::vector<Users> table = {
      {"Geometry/",
       {mesh, mesh_export, modes, response, record, record_and_model, whole_job, transient}},
      {"Materials/",
       {mesh_export, modes, response, record, record_and_model, whole_job, transient}},
      {"Materials/",
       {mesh, mesh_export, modes, response, record, record_and_model, whole_job, transient},
       "/Density"},
      {"Materials/",
       {modes, response, record, record_and_model, whole_job, transient},
       "/Loss factor"},
      {"Materials/", {transient}, "/Prony moduli"},
      {"Materials/", {transient}, "/Prony times"},
      {"Materials/", {modes, transient}, "/c2"},
      {"Materials/", {modes, transient}, "/c3"},
      {"Materials/", {modes, transient}, "/Volumetric law"},
      {"Model/", {modes, response, record, record_and_model, whole_job, transient}},
      {"Model/Mesh",
       {mesh, mesh_export, modes, response, record, record_and_model, whole_job, transient}},
      {"Model/Number of modes",
       {mesh_export, modes, response, record, record_and_model, whole_job, transient}},
      {"Model/Wind on", {record, record_and_model, whole_job, transient}},
      {"Model/Sensitivities", {record_and_model, whole_job}},
      {"Model/Calibrat", {modes, record, record_and_model, whole_job}},
      {"Base motion/", {record, record_and_model, whole_job, transient}},
      {"Wind/", {record, record_and_model, whole_job, transient}},
      {"Wind/Pressure acts on", {transient}},
      {"Records/", {record, record_and_model, whole_job, transient}},
      {"Records/Accelerometer noise", {record, record_and_model, whole_job}},
      {"Records/Moment noise", {record, record_and_model, whole_job}},
      {"Transient/", {transient}},
      {"Transient/Gravity", {modes, transient}},
      {"Separation/", {whole_job}},
      {"Output/", {whole_job}},
      {"Output/Folder", {whole_job, transient}},
  };
  return table;
}

/// Entries that count only where another one has one of these values.
struct Condition {
  std::string beginning, section, entry;
  std::vector<std::string> values;
  Uses uses = {mesh, mesh_export, modes, response, record, record_and_model, whole_job, transient};
  std::string ending = "";
};

const std::vector<Condition>& conditions() {
  static const std::vector<Condition> table = {
      {"Model/Mesh resolution", "Model", "Mesh file", {""}},
      // Elsewhere the wind needs widths and height.
      {"Geometry/", "Model", "Mesh file", {""}, {mesh, mesh_export, modes, response}},
      {"Model/Damping ratios", "Model", "Damping", {"modal"}},
      {"Geometry/Fin ", "Geometry", "Fin", {"cross", "plate"}},
      {"Materials/Fin/", "Geometry", "Fin", {"cross", "plate"}},
      {"Materials/",
       "Model",
       "Damping",
       {"material"},
       {modes, response, record, record_and_model, whole_job, transient},
       "/Loss factor"},
      {"Materials/", "Transient", "Strain", {"finite"}, {transient}, "/Prony moduli"},
      {"Materials/", "Transient", "Strain", {"finite"}, {transient}, "/Prony times"},
      {"Materials/", "Transient", "Strain", {"finite"}, {transient}, "/c2"},
      {"Materials/", "Transient", "Strain", {"finite"}, {transient}, "/c3"},
      {"Materials/", "Transient", "Strain", {"finite"}, {transient}, "/Volumetric law"},
      {"Base motion/Lines", "Base motion", "Kind", {"multisine"}},
      {"Base motion/Peak", "Base motion", "Kind", {"multisine"}},
      {"Base motion/Phases", "Base motion", "Kind", {"multisine"}},
      {"Base motion/Recorded/", "Base motion", "Kind", {"recorded"}},
      {"Wind/Mean speed", "Wind", "Kind", {"steady", "sines", "turbulent"}},
      {"Wind/Sine ", "Wind", "Kind", {"sines"}},
      {"Wind/Turbulence", "Wind", "Kind", {"turbulent"}},
      {"Wind/Length scale", "Wind", "Kind", {"turbulent"}},
      {"Wind/Maximum speed", "Wind", "Kind", {"turbulent"}},
      {"Wind/Recorded/", "Wind", "Kind", {"recorded"}},
      {"Wind/Profile", "Wind", "Kind", {"steady", "sines", "turbulent", "recorded"}},
      {"Wind/Air", "Wind", "Kind", {"steady", "sines", "turbulent", "recorded"}},
      {"Wind/Relative", "Wind", "Kind", {"steady", "sines", "turbulent", "recorded"}},
      {"Model/Wind on", "Wind", "Kind", {"steady", "sines", "turbulent", "recorded"}},
      {"Transient/Time tolerance", "Transient", "Substep choice", {"adaptive"}},
      {"Transient/Least displacement", "Transient", "Substep choice", {"adaptive"}},
      {"Transient/Most substeps", "Transient", "Substep choice", {"adaptive"}},
      {"Transient/Force tolerance", "Transient", "Strain", {"finite"}},
      {"Wind/Pressure acts on", "Transient", "Strain", {"finite"}},
  };
  return table;
}

const char* name_of(const CaseUse use) {
  switch (use) {
    case mesh:
      return "'vibrissa mesh' without --calculix";
    case mesh_export:
      return "'vibrissa mesh'";
    case modes:
      return "'vibrissa modes'";
    case response:
      return "'vibrissa bode'";
    case record:
      return "'vibrissa simulate' without --write-model";
    case record_and_model:
      return "'vibrissa simulate'";
    case whole_job:
      return "'vibrissa run'";
    case transient:
      break;
  }
  return "'vibrissa transient'";
}

bool is_used(const CaseUse use, const std::string& path) {
  const Users* longest = nullptr;
  for (const Users& entry : users())
    if (entry.matches(path) && (longest == nullptr || entry.length() > longest->length()))
      longest = &entry;
  return longest == nullptr || std::ranges::count(longest->uses, use) > 0;
}

std::string unmet_condition(const CaseUse use, const CaseFile& file, const std::string& path) {
  for (const Condition& condition : conditions()) {
    const bool applies = path.starts_with(condition.beginning) &&
                         path.ends_with(condition.ending) &&
                         std::ranges::count(condition.uses, use) > 0;
    if (!applies) continue;
    const std::string value = file.get(condition.section, condition.entry);
    if (std::ranges::count(condition.values, value) == 0)
      return condition.section + "/" + condition.entry + " is " + (value.empty() ? "empty" : value);
  }
  return "";
}

}  // namespace

std::string why_unused(const CaseUse use, const CaseFile& file, const std::string& path) {
  if (!is_used(use, path)) return std::string(name_of(use)) + " does not use it";
  const std::string condition = unmet_condition(use, file, path);
  return condition.empty() ? "" : "it has no effect, because " + condition;
}

}  // namespace vibrissa::sensor_case
