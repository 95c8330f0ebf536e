#include "apps/solid/jobs/case_options.h"

namespace vibrissa::apps {

void CaseOptions::add_settings_to(CLI::App& command, const sensor_case::CaseUse used_for) {
  use = used_for;
  command.add_option("--set", settings,
                     "Sets an entry of the case file: SECTION/ENTRY=VALUE; repeatable");
}

void CaseOptions::add_case_to(CLI::App& command, const sensor_case::CaseUse used_for) {
  command.add_option("case", case_file, "Case file (.prm)")->required();
  add_settings_to(command, used_for);
}

void CaseOptions::add_to(CLI::App& command, const sensor_case::CaseUse used_for) {
  add_case_to(command, used_for);
  command.add_option("--base-acceleration", base_acceleration_file,
                     "File with a recorded base acceleration (CSV, .mat, .h5, .npy, .uff, .wav)");
  command.add_option("--wind", wind_file, "File with a recorded wind speed");
  command.add_option("--column", columns,
                     "Takes a column of these files as a channel: CHANNEL=COLUMN, with the unit in "
                     "square brackets and a factor where needed, e.g. 'base_acceleration=ax[g]'; "
                     "channels: base_acceleration, wind_speed; repeatable");
  command.add_option("--rate", rates,
                     "Rate at which these files were recorded [Hz], for files without time: HZ, or "
                     "CHANNEL=HZ for one of them; repeatable");
  command.add_option("--rows", rows,
                     "CHANNEL=FIRST:LAST: data rows that are used, counted from 1; repeatable");
  command.add_option(
      "--range", ranges,
      "Rescales the recording linearly: CHANNEL=LOW:HIGH, the minimum of the rows used becomes LOW "
      "and its maximum HIGH (SI units); repeatable");
  command.add_option("--remove-mean", remove_means,
                     "CHANNEL whose mean (gravity) is subtracted; repeatable");
  command.add_option("--duration", duration_s,
                     "Length of each simulated record [s] (default: that of the case file)");
}

void CaseOptions::add_folder_to(CLI::App& command) {
  command.add_option("-o,--output,--out", output_folder,
                     "Results folder; must not exist yet (default: the entry Output/Folder of the "
                     "case file; if it is empty, a new folder in results/)");
}

}  // namespace vibrissa::apps
