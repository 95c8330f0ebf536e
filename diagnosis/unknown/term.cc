#include "diagnosis/unknown/unknown_cause.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

/// The inputs of the records in shares of their largest rms in the fitted records, to be read at
/// any time.
class Inputs {
 public:
  enum Channel : std::size_t { acceleration, wind, n_channels };

  Inputs(std::span<const PreparedRecord> fitted, std::span<const PreparedRecord> further) {
    for (const PreparedRecord& record : fitted) {
      const Series& series = add(record);
      for (std::size_t c = 0; c < n_channels; ++c)
        if (!series.x[c].empty()) rms_[c] = std::max(rms_[c], std::sqrt(mean_square(series.x[c])));
    }
    for (const PreparedRecord& record : further) add(record);
  }

  bool has(const Channel channel) const { return rms_[channel] > 0.; }
  /// Linear between samples; zero where the record has no such input.
  double at(const Channel channel, const std::size_t record, const double t_s) const {
    const auto found = series_.find(record);  // lanes without a record have number 0
    if (found == series_.end() || found->second.x[channel].empty()) return 0.;
    const std::vector<double>& x = found->second.x[channel];
    const double inside =
        std::clamp(t_s * found->second.rate_hz, 0., static_cast<double>(x.size() - 1));
    const auto i = static_cast<std::size_t>(inside);
    return std::lerp(x[i], x[std::min(i + 1, x.size() - 1)], inside - static_cast<double>(i)) /
           rms_[channel];
  }

 private:
  struct Series {
    double rate_hz = 1.;
    std::array<std::vector<double>, n_channels> x{};
  };
  const Series& add(const PreparedRecord& record) {
    Series& series = series_[record.number];
    series.rate_hz = record.sampling_rate_hz;
    if (!record.acceleration.empty())
      series.x[acceleration] = samples_of(record.acceleration, record.n_samples);
    series.x[wind] = record.wind;
    return series;
  }

  std::map<std::size_t, Series> series_;
  std::array<double, n_channels> rms_{};
};

/// What a term of the joint may depend on.
struct State {
  double angle, rate, acceleration, wind;
};
using Function = double (*)(const State&);

class TermLaw : public JointLaw {
 public:
  TermLaw(Function function, double coefficient, const Scales& scales,
          std::shared_ptr<const Inputs> inputs, const Lanes& numbers)
      : function_(function),
        coefficient_(coefficient),
        scales_(scales),
        inputs_(std::move(inputs)),
        numbers_(numbers) {}

  Lanes moment(const Lanes& y, const Lanes& y_rate, const Lanes& t_s, double, bool) override {
    // Powers of a motion beyond the recorded ones would only upset the integration.
    constexpr double most = 3.;
    Lanes out;
    for (Eigen::Index i = 0; i < out.size(); ++i) {
      const auto number = static_cast<std::size_t>(numbers_(i));
      const State state{
          std::clamp(y(i) / scales_.joint_moment_n_m, -most, most),
          std::clamp(y_rate(i) / (scales_.joint_moment_n_m * scales_.first_mode_rad_s), -most,
                     most),
          inputs_->at(Inputs::acceleration, number, t_s(i)),
          inputs_->at(Inputs::wind, number, t_s(i))};
      out(i) = coefficient_ * scales_.joint_moment_n_m * function_(state);
    }
    return out;
  }

 private:
  Function function_;
  double coefficient_;
  Scales scales_;
  std::shared_ptr<const Inputs> inputs_;
  Lanes numbers_;
};

double sign(const double x) {
  constexpr double width = 0.02;  // of the peak: a jump upsets the integration
  return std::tanh(x / width);
}

struct JointTerm {
  const char* name;
  Function function;
  bool acceleration = false, wind = false;
  const char* like = "";
};

const std::vector<JointTerm>& joint_terms() {
  static const std::vector<JointTerm> terms{
      {"angle^2", [](const State& s) { return s.angle * s.angle; }},
      {"|angle|", [](const State& s) { return std::abs(s.angle); }},
      {"angle |angle|", [](const State& s) { return s.angle * std::abs(s.angle); }},
      {"angle^3", [](const State& s) { return s.angle * s.angle * s.angle; }, false, false,
       "hardening"},
      {"angle^5", [](const State& s) { return std::pow(s.angle, 5); }},
      {"sign(angle)", [](const State& s) { return sign(s.angle); }, false, false, "backlash"},
      {"rate^2", [](const State& s) { return s.rate * s.rate; }},
      {"rate |rate|", [](const State& s) { return s.rate * std::abs(s.rate); }},
      {"rate^3", [](const State& s) { return s.rate * s.rate * s.rate; }},
      {"sign(rate)", [](const State& s) { return sign(s.rate); }, false, false, "joint_friction"},
      {"angle rate", [](const State& s) { return s.angle * s.rate; }},
      {"|angle| rate", [](const State& s) { return std::abs(s.angle) * s.rate; }},
      {"angle^2 rate", [](const State& s) { return s.angle * s.angle * s.rate; }},
      {"angle rate^2", [](const State& s) { return s.angle * s.rate * s.rate; }},
      {"acceleration angle", [](const State& s) { return s.acceleration * s.angle; }, true},
      {"acceleration rate", [](const State& s) { return s.acceleration * s.rate; }, true},
      {"acceleration |acceleration|",
       [](const State& s) { return s.acceleration * std::abs(s.acceleration); }, true},
      {"wind", [](const State& s) { return s.wind; }, false, true},
      {"wind rate", [](const State& s) { return s.wind * s.rate; }, false, true, "relative_drag"},
      {"wind angle", [](const State& s) { return s.wind * s.angle; }, false, true},
      {"wind^2 rate", [](const State& s) { return s.wind * s.wind * s.rate; }, false, true,
       "relative_drag"},
      {"wind^2 angle", [](const State& s) { return s.wind * s.wind * s.angle; }, false, true},
      {"wind^3", [](const State& s) { return s.wind * s.wind * s.wind; }, false, true},
      {"wind acceleration", [](const State& s) { return s.wind * s.acceleration; }, true, true}};
  return terms;
}

/// Reading plus coefficient times a function of itself, in shares of the peak.
struct ReadingTerm {
  const char *name, *like;
  double (*function)(double);
};
constexpr ReadingTerm reading_terms[] = {
    {"moment^2", "sensor_nonlinearity", [](double x) { return x * x; }},
    {"moment |moment|", "", [](double x) { return x * std::abs(x); }},
    {"moment^3", "sensor_nonlinearity", [](double x) { return x * x * x; }},
    {"sign(moment)", "", [](double x) { return sign(x); }}};

/// What a wrong calibration does; the coefficient is the logarithm of its ratio.
Term calibration(const Effect& effect, const Scales& scales) {
  return {.name = effect.id, .basic = true, .add = [&effect, scales](Chain& chain, double c) {
            std::vector<double> values{std::exp(c)};
            for (std::size_t i = 1; i < effect.parameters.size(); ++i)
              values.push_back(effect.parameters[i].neutral);
            effect.extend(chain, values, scales);
          }};
}

void add_reading_terms(const Experiment& experiment, const Scales& scales, std::vector<Term>& out) {
  out.push_back({.name = "delay",
                 .place = TermPlace::reading,
                 .like = "delay",
                 .add = [w = scales.first_mode_rad_s](Chain& chain, double c) {
                   chain.sensor.push_back([w, c](Complex s) { return std::exp(-c * s / w); });
                 }});
  for (const ReadingTerm& term : reading_terms)
    out.push_back(
        {.name = term.name,
         .place = TermPlace::reading,
         .like = term.like,
         .add = [peak = scales.joint_moment_n_m, function = term.function](Chain& chain, double c) {
           chain.readout.push_back([peak, function, c](double moment) {
             constexpr double most = 3.;
             return moment + c * peak * function(std::clamp(moment / peak, -most, most));
           });
         }});
  if (!experiment.has_base) return;
  for (const bool of_rate : {false, true})
    out.push_back(
        {.name = of_rate ? "acceleration's rate" : "acceleration",
         .place = TermPlace::reading,
         .like = of_rate ? "" : "coil_feedthrough",
         .add = [of_rate, scales, gain = experiment.scales.static_gain](Chain& chain, double c) {
           chain.feedthrough.push_back([of_rate, scales, gain, c](Complex s) {
             return c * gain * (of_rate ? s / scales.first_mode_rad_s : Complex(1.));
           });
         }});
}

}  // namespace

std::string to_string(const TermPlace place) {
  return place == TermPlace::joint ? "joint" : "reading";
}

std::vector<Term> all_terms(const Experiment& experiment, std::span<const PreparedRecord> further) {
  const auto inputs = std::make_shared<const Inputs>(experiment.records, further);
  const Scales& scales = experiment.scales;
  std::vector<Term> out;
  for (const Effect& effect : effect_catalogue())
    if (effect.calibration && shows(experiment, effect))
      out.push_back(calibration(effect, experiment.scales));
  if (!experiment.nominal.modes.empty()) {
    for (const JointTerm& term : joint_terms()) {
      if ((term.acceleration && !inputs->has(Inputs::acceleration)) ||
          (term.wind && !inputs->has(Inputs::wind)))
        continue;
      out.push_back({.name = term.name,
                     .like = term.like,
                     .add = [function = term.function, scales, inputs](Chain& chain, double c) {
                       chain.joint.push_back([function, scales, inputs, c](const Lanes& numbers) {
                         return std::make_unique<TermLaw>(function, c, scales, inputs, numbers);
                       });
                     }});
    }
  }
  add_reading_terms(experiment, scales, out);
  return out;
}

}  // namespace vibrissa::diagnosis
