// Identifies the base vibration response in a record and takes the vibration out of its moment.
// usage: separate_a_record RECORD.csv SEPARATED.csv
#include <iostream>

#include "separation/filters/bvrm_separator.h"
#include "separation/identification/identify.h"
#include "signals/base/error.h"
#include "signals/files/record_io.h"

int main(int argc, char** argv) {
  using namespace vibrissa;
  if (argc != 3) {
    std::cerr << "usage: separate_a_record RECORD.csv SEPARATED.csv\n";
    return 2;
  }
  try {
    signals::Record record = signals::read_record(argv[1]);
    const auto [fit, held_out] = separation::hold_out_last_third(record);
    const auto found = separation::identify_bvrm(fit, held_out);
    std::cout << "fit on the held-out third: " << found.held_out_fit_percent << " %\n";
    separation::BvrmSeparator separator(found.fit.model, record.sampling_rate_hz(), found.hold);
    record.set_channel(signals::channel::wind_moment,
                       separation::separate_record(separator, record));
    signals::write_record(argv[2], record);
  } catch (const signals::UserError& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}
