#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "separation/model/input_hold.h"
#include "separation/model/rational_model.h"
#include "separation/nonlinear/joint_law.h"

namespace vibrissa::separation {

/// What the moment channel shows of the law's force.
enum class LawReadout {
  moment,     // the joint's whole moment: the law adds b0 / a0 times its force
  deflection  // the deflection alone (a rotation sensor): the law acts through the motion only
};
std::string to_string(LawReadout readout);
LawReadout parse_law_readout(const std::string& name);

/// Nonlinear base vibration response model: a Bvrm, one mode of which has a joint law f,
///   x'' + a1 x' + a0 x + f(x, x') = a,   M = b0 x + b1 x' [+ (b0 / a0) f] + the other modes + D a,
/// the bracket with LawReadout::moment: an elastic joint of stiffness k carries k x + its law
/// (Kerschen et al. 2006, Mechanical Systems and Signal Processing 20, section 2; the law in one
/// coordinate is a static nonlinear feedback, Schoukens & Ljung 2019, IEEE Control Systems 39(6)).
struct NonlinearBvrm {
  Bvrm linear;
  std::size_t mode = 0;  // the one with the law
  std::vector<LawTerm> law;
  LawReadout readout = LawReadout::moment;
  std::optional<Hold> hold = std::nullopt;  // of the fit
  /// Largest deflection and speed of that mode in the fit; beyond, the law is extrapolated.
  double largest_deflection_m = 0., largest_speed_m_s = 0.;

  /// Moment per force of the law [kg m].
  double law_gain_kg_m() const;
  /// The given hold, else the hold of the fit, else first_order.
  Hold hold_or(const std::optional<Hold>& told) const;
};

/// The linear model that it is in the limit of small amplitude: a1, a0 and with LawReadout::moment
/// b1, b0 grow by the slopes of the law at rest, which only friction (c / v) and monomials of
/// degree one have. Proven by tests/separation/nonlinear/nonlinear_bvrm_test.cc.
Bvrm at_small_amplitude(const NonlinearBvrm& model);

/// Deflection in multiples of the largest one of the fit beyond which the state counts as diverged
/// and starts again at rest, for a law that softens can run away.
inline constexpr double diverged_in_largest_deflections = 1e3;

/// Throws UserError as check(Bvrm) and check(law) do, and for a mode that the model does not have
/// or a largest deflection or speed that is not positive. Proven by
/// tests/separation/nonlinear/nonlinear_bvrm_test.cc.
void check(const NonlinearBvrm& model);

/// {"schema": "vibrissa-nonlinear-bvrm-1", "linear": JSON of the Bvrm, "hold", "mode" (counted from
/// 1), "readout", "law": [{"kind", "coefficient", "unit", "deflection_power", "velocity_power",
/// "speed_m_s"}], "largest_deflection_m", "largest_speed_m_s"}.
nlohmann::json to_json(const NonlinearBvrm& model);
/// Throws UserError with the place for an entry that is missing, of the wrong type or not possible.
NonlinearBvrm nonlinear_bvrm_from_json(const nlohmann::json& json, const std::string& where);
/// Whether the file is JSON with the schema of a nonlinear model.
bool is_nonlinear_bvrm(const std::filesystem::path& file);
NonlinearBvrm read_nonlinear_bvrm(const std::filesystem::path& file);
void write_nonlinear_bvrm(const std::filesystem::path& file, const NonlinearBvrm& model);

}  // namespace vibrissa::separation
