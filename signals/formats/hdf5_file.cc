#include "signals/formats/hdf5_file.h"

#include <stdexcept>

#include "signals/base/error.h"
#include "signals/formats/hdf5_image.h"
#include "signals/formats/matrix_columns.h"
#include "signals/formats/record_columns.h"
#include "signals/system/file_bytes.h"
#include "signals/system/rehearsal.h"

namespace vibrissa::signals::formats {
namespace {

std::vector<NumericColumn> all_columns(const Hdf5Reader& file, const std::string& name) {
  std::vector<NumericColumn> columns;
  std::size_t n_numbers = 0;
  for (const Hdf5Reader::Array& array : file.arrays()) {
    if (array.size() > most_numbers - n_numbers)
      throw UserError(name + ": '" + array.path + "' declares " + std::to_string(array.size()) +
                      " numbers; at most " + std::to_string(most_numbers) +
                      " are read from one file");
    n_numbers += array.size();
    if (array.size() == 0) continue;
    for (NumericColumn& column :
         columns_of({array.path, array.shape, file.numbers(array.path), array.single_precision,
                     /*first_index_first=*/false})) {
      column.unit = array.unit;
      columns.push_back(std::move(column));
    }
  }
  return columns;
}

}  // namespace

std::unique_ptr<RecordTable> read_hdf5(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::string image = read_bytes(file);
  const auto read = [&] { return all_columns(Hdf5Reader(image), name); };
  rehearse(name, image.size(), read);
  try {
    return std::make_unique<NumericTable>(name, read());
  } catch (const UserError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw UserError(name + ": cannot be read as HDF5: " + error.what());
  }
}

void write_hdf5(const std::filesystem::path& file, const Record& record) {
  Hdf5Writer writer;
  writer.describe(
      "conventions",
      "Sample i is at time_s[i] = start_s + i / sampling_rate_hz. Names end in SI units. "
      "base_moment is what the sensor exerts on the support about the base centre, positive "
      "for wind in +x.");
  for_each_array(record, [&](const std::string& name, const std::span<const double> values) {
    writer.add(name, values);
  });
  write_bytes(file, writer.image());
}

}  // namespace vibrissa::signals::formats
