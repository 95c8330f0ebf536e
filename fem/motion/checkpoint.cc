#include "fem/motion/checkpoint.h"

#include <deal.II/base/mpi.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <fstream>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "signals/base/error.h"
#include "signals/formats/hdf5_image.h"
#include "signals/system/output_file.h"
#include "signals/system/sha256.h"

namespace vibrissa::fem {

namespace {

using signals::UserError;

constexpr const char* kind = "vibrissa transient checkpoint 1";

MPI_Comm communicator_of(const TransientRun& run) {
  return run.sensor().state().displacement.get_mpi_communicator();
}

/// Text before the HDF5 file: its type, and the checksum of the rest.
constexpr std::size_t seal_size = 512;
std::string seal_of(const std::string_view image) {
  std::ostringstream text;
  text << kind << "\nsha256 " << signals::sha256(image) << "\n";
  std::string seal(seal_size, '\0');
  const std::string line = text.str();
  std::copy(line.begin(), line.end(), seal.begin());
  return seal;
}

std::vector<double> columns_of(const std::vector<EnergyBalance>& energy) {
  std::vector<double> values;
  for (const auto& e : energy)
    values.insert(values.end(), {e.kinetic_j, e.stored_j, e.dissipated_j, e.numerical_j, e.work_j});
  return values;
}

std::vector<EnergyBalance> energies_of(const std::vector<double>& values) {
  std::vector<EnergyBalance> energy;
  for (std::size_t i = 0; i + 4 < values.size(); i += 5)
    energy.push_back({values[i], values[i + 1], values[i + 2], values[i + 3], values[i + 4]});
  return energy;
}

std::vector<double> columns_of(const std::vector<IntervalSteps>& intervals) {
  std::vector<double> values;
  for (const auto& interval : intervals) {
    const double substeps = interval.substeps, n_rejected = interval.n_rejected;
    values.insert(values.end(), {substeps, n_rejected, interval.error});
  }
  return values;
}

std::vector<IntervalSteps> intervals_of(const std::vector<double>& values) {
  std::vector<IntervalSteps> intervals;
  for (std::size_t i = 0; i + 2 < values.size(); i += 3)
    intervals.push_back({static_cast<unsigned int>(values[i]),
                         static_cast<unsigned int>(values[i + 1]), values[i + 2]});
  return intervals;
}

void add_record(signals::Hdf5Writer& file, const TransientOutput& output) {
  file.add("record/base_moment_N_m", output.base_moment);
  file.add("record/cross_moment_N_m", output.cross_moment);
  file.add("record/energy_J", columns_of(output.energy));
  file.add("record/substeps_rejected_and_error", columns_of(output.intervals));
  const std::vector<double> rest{output.largest_component, output.largest_difference,
                                 static_cast<double>(output.count.n_steps),
                                 static_cast<double>(output.count.n_iterations),
                                 static_cast<double>(output.count.n_factorisations)};
  file.add("record/routes_and_counts", rest);
}

TransientOutput read_record(const signals::Hdf5Reader& file) {
  TransientOutput output;
  output.base_moment = file.numbers("record/base_moment_N_m");
  output.cross_moment = file.numbers("record/cross_moment_N_m");
  output.energy = energies_of(file.numbers("record/energy_J"));
  output.intervals = intervals_of(file.numbers("record/substeps_rejected_and_error"));
  const auto rest = file.numbers("record/routes_and_counts");
  output.largest_component = rest.at(0);
  output.largest_difference = rest.at(1);
  output.count = {static_cast<std::size_t>(rest.at(2)), static_cast<std::size_t>(rest.at(3)),
                  static_cast<std::size_t>(rest.at(4))};
  return output;
}

TransientMemory read_memory(const signals::Hdf5Reader& file, const Vector& like) {
  TransientMemory memory;
  const auto rank =
      std::to_string(dealii::Utilities::MPI::this_mpi_process(like.get_mpi_communicator()));
  if (file.has("own")) {
    for (const auto& name : file.names("own"))
      memory.own[name] = file.numbers("own/" + name + "/" + rank);
  }
  for (const auto& name : file.names("numbers"))
    memory.numbers[name] = file.numbers("numbers/" + name).at(0);
  for (const auto& name : file.names("vectors")) {
    const auto values = file.numbers("vectors/" + name);
    if (values.size() != like.size())
      throw std::runtime_error("'vectors/" + name + "' and the model have different lengths");
    Vector& vector = memory.vectors.emplace(name, like).first->second;
    for (const auto i : vector.locally_owned_elements()) vector[i] = values[i];
    vector.compress(dealii::VectorOperation::insert);
  }
  return memory;
}

/// Text of the first line in which two texts differ; empty when they are equal.
std::string first_difference(const std::string& there, const std::string& here) {
  std::istringstream in_there(there), in_here(here);
  std::string a, b, section;
  while (true) {
    const bool more_a = static_cast<bool>(std::getline(in_there, a));
    const bool more_b = static_cast<bool>(std::getline(in_here, b));
    if (!more_a && !more_b) return "";
    if (!more_a || !more_b || a != b)
      return (section.empty() ? "" : "in '" + section + "' ") + "it has '" +
             (more_a ? a.substr(a.find_first_not_of(' ')) : "nothing") + "', but this run has '" +
             (more_b ? b.substr(b.find_first_not_of(' ')) : "nothing") + "'";
    if (a.rfind("subsection ", 0) == 0) section = a.substr(11);
  }
}

/// The data of each process, on the first process.
std::vector<std::vector<double>> gather(const std::vector<double>& own, MPI_Comm communicator) {
  const auto n_processes = dealii::Utilities::MPI::n_mpi_processes(communicator);
  const int n_own = static_cast<int>(own.size());
  std::vector<int> sizes(n_processes), starts(n_processes);
  MPI_Gather(&n_own, 1, MPI_INT, sizes.data(), 1, MPI_INT, 0, communicator);
  std::exclusive_scan(sizes.begin(), sizes.end(), starts.begin(), 0);
  std::vector<double> all(static_cast<std::size_t>(starts.back() + sizes.back()));
  MPI_Gatherv(own.data(), n_own, MPI_DOUBLE, all.data(), sizes.data(), starts.data(), MPI_DOUBLE, 0,
              communicator);
  std::vector<std::vector<double>> of_processes;
  if (dealii::Utilities::MPI::this_mpi_process(communicator) != 0) return of_processes;
  for (std::size_t rank = 0; rank < sizes.size(); ++rank)
    of_processes.emplace_back(all.begin() + starts[rank], all.begin() + starts[rank] + sizes[rank]);
  return of_processes;
}

std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file))
    throw UserError(file.string() + ": there is no checkpoint to resume from");
  std::ostringstream content;
  content << in.rdbuf();
  return content.str();
}

void check_whole(const std::filesystem::path& file, const std::string& image) {
  if (image.rfind(kind, 0) != 0)
    throw UserError(file.string() +
                    ": is not a checkpoint of a transient (it does not begin with '" + kind + "')");
  if (image.size() <= seal_size ||
      image.rfind(seal_of(std::string_view(image).substr(seal_size)), 0) != 0)
    throw UserError(file.string() +
                    ": the checkpoint is damaged (its content does not match its SHA-256); start "
                    "the run again, or use a copy of the file");
}

void check_owner(const std::filesystem::path& file, const signals::Hdf5Reader& content,
                 const CheckpointOwner& owner, const double n_processes) {
  const auto refuse = [&](const std::string& reason) {
    throw UserError(file.string() + ": the checkpoint belongs to another run: " + reason);
  };
  const auto difference = first_difference(content.text("owner/case"), owner.case_text);
  if (!difference.empty()) refuse(difference);
  for (const auto& [name, digest] : owner.digests)
    if (content.text("owner/sha256_of_" + name) != digest) refuse("its " + name + " differs");
  const double there = content.numbers("owner/n_processes").at(0);
  if (there != n_processes)
    refuse("it was written by " + std::to_string(static_cast<int>(there)) +
           " processes; use the same number of processes");
}

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const TransientRun& run,
                      const CheckpointOwner& owner) {
  const MPI_Comm communicator = communicator_of(run);
  const bool writes = dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
  signals::Hdf5Writer content;
  const TransientMemory memory = run.sensor().memory();
  for (const auto& [name, vector] : memory.vectors) {
    const dealii::Vector<double> whole(vector);
    if (writes) content.add("vectors/" + name, std::span(whole.begin(), whole.size()));
  }
  for (const auto& [name, values] : memory.own) {
    const auto of_processes = gather(values, communicator);
    for (std::size_t rank = 0; rank < of_processes.size(); ++rank)
      content.add("own/" + name + "/" + std::to_string(rank), of_processes[rank]);
  }
  if (!writes) return;
  for (const auto& [name, number] : memory.numbers)
    content.add("numbers/" + name, std::span(&number, 1));
  add_record(content, run.output());
  content.add("owner/case", owner.case_text);
  for (const auto& [name, digest] : owner.digests) content.add("owner/sha256_of_" + name, digest);
  content.add("owner/program_revision", owner.program_revision);
  const double n_processes = dealii::Utilities::MPI::n_mpi_processes(communicator);
  content.add("owner/n_processes", std::span(&n_processes, 1));
  const std::string image = content.image();
  signals::write_file(file, [&](std::ostream& out) { out << seal_of(image) << image; });
}

std::string read_checkpoint(const std::filesystem::path& file, const CheckpointOwner& owner,
                            TransientRun& run) {
  const std::string image = read_file(file);
  check_whole(file, image);
  try {
    const signals::Hdf5Reader content(image);
    check_owner(file, content, owner,
                dealii::Utilities::MPI::n_mpi_processes(communicator_of(run)));
    run.restore(read_memory(content, run.sensor().state().displacement), read_record(content));
    return content.text("owner/program_revision");
  } catch (const UserError&) {
    throw;
  } catch (const std::exception& error) {
    throw UserError(file.string() + ": the checkpoint cannot be used: " + error.what());
  }
}

}  // namespace vibrissa::fem
