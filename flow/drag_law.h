#pragma once

namespace vibrissa::flow {

enum class DragBody { wire, blades };

/// Air at 20 C and sea level.
struct Air {
  double density = 1.204;                // kg/m^3
  double kinematic_viscosity = 1.51e-5;  // m^2/s
};

/// Drag coefficient on the frontal area at Reynolds number Re = |u| width / nu > 0. wire: smooth
/// circular cylinder across the flow, Cd = 1 + 10 Re^(-2/3) (White, Viscous Fluid Flow, 1 < Re <
/// 2e5). It is used down to Re = 0.382, where it equals the law for slow flow, which is used below:
/// Cd = 8 pi/Re (d - 0.87 d^3), d = 1/(1/2 - gamma - ln(Re/8)), gamma = 0.5772 (Lamb 1911 with the
/// third-order term of Kaplun 1957; Van Dyke, Perturbation Methods in Fluid Mechanics, chapter
/// VIII). Continuous; within 20 % of Cheng's (2013) fit to measurements from Re = 0.01 to 2e5, but
/// 7 to 14 % above it from Re = 10 to 150, the usual range of the wire. The drag crisis is not
/// included: not valid for Re > 2e5. blades: flat plate normal to the flow, aspect ratio 3 to 5, Cd
/// = 1.2 at any Re (Hoerner, Fluid-Dynamic Drag, 1965, ch. 3; measured above Re = 1000). Proven by
/// tests/flow/drag_law_test.cc.
double drag_coefficient(DragBody body, double reynolds);

/// Uniform windward pressure whose resultant is the drag: p = 0.5 rho Cd(Re) u |u| [Pa], signed as
/// u. Continuous through p(0) = 0, where Re Cd stays finite. Proven by drag_law_test.cc,
/// DragPressure.
double drag_pressure(DragBody body, double width_m, double speed_m_s, const Air& air);

}  // namespace vibrissa::flow
