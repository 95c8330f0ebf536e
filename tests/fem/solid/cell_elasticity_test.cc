#include "fem/solid/cell_elasticity.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "fem/solid/element_matrices.h"
#include "meshes/regions.h"

namespace vibrissa::fem {
namespace {

using materials::VolumetricLaw;
using NodalVector = Eigen::Matrix<double, 81, 1>;

struct NamedMaterial {
  const char* name;
  materials::Material material;
};

std::vector<NamedMaterial> all_laws() {
  materials::Material stiffening = materials::make_elastic(1e6, 0.4, 1000., 0.);
  stiffening.volumetric.kind = VolumetricLaw::Kind::hartmann_neff;
  return {{"Yeoh", materials::make_yeoh({3.4e5, 1.7152e5, 1.32e8}, 1.5e9, 1080., 0.)},
          {"NeoHookean", materials::make_elastic(1e6, 0.33, 1000., 0.)},
          {"HartmannNeff", stiffening}};
}

/// One skewed cell.
class Elasticity : public testing::TestWithParam<NamedMaterial> {
 protected:
  Elasticity() {
    const std::vector<dealii::Point<3>> vertices{{0, 0, 0},     {1.1, .1, .05}, {-.1, .9, 0},
                                                 {1, 1.2, -.1}, {.1, 0, 1},     {1.3, 0, 1.1},
                                                 {0, 1.1, .9},  {1, 1, 1.2}};
    std::vector<dealii::CellData<3>> cells(1);
    for (unsigned int v = 0; v < 8; ++v) cells[0].vertices[v] = v;
    mesh.create_triangulation(vertices, cells, {});
    mesh.begin_active()->face(4)->set_boundary_id(meshes::boundary::clamp);
    const SolidSpace space(mesh);
    ElementMatrices element(space);
    element.reinit(mesh.begin_active());
    element.stiffness(material, stiffness);
    cell = element.integrals();
    dealii::FEValues<3> values(
        space.mapping(), space.scalar_element(),
        dealii::Quadrature<3>(space.scalar_element().get_unit_support_points()),
        dealii::update_quadrature_points);
    values.reinit(mesh.begin_active());
    for (unsigned int n = 0; n < 27; ++n) {
      for (unsigned int c = 0; c < 3; ++c) position[3 * n + c] = values.quadrature_point(n)[c];
    }
  }

  static NodalVector random(const unsigned int seed, const double size) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> entry(-size, size);
    NodalVector u;
    for (double& value : u) value = entry(engine);
    return u;
  }
  /// (F - I) X at every node.
  NodalVector affine(const Eigen::Matrix3d& f) const {
    NodalVector u;
    for (int n = 0; n < 27; ++n) {
      u.segment<3>(3 * n) = (f - Eigen::Matrix3d::Identity()) * position.segment<3>(3 * n);
    }
    return u;
  }
  static CellElasticity::Nodal nodal(const NodalVector& u) {
    CellElasticity::Nodal values;
    std::copy(u.begin(), u.end(), values.begin());
    return values;
  }

  double energy(const NodalVector& u) { return elasticity.deform(cell, material, nodal(u)); }
  NodalVector force(const NodalVector& u) {
    CellElasticity::Nodal f;
    elasticity.deform(cell, material, nodal(u));
    elasticity.force(f);
    return Eigen::Map<const NodalVector>(f.data());
  }
  Eigen::MatrixXd tangent(const NodalVector& u) {
    elasticity.deform(cell, material, nodal(u));
    elasticity.tangent(blocks);
    Eigen::MatrixXd k(81, 81);
    int pair = 0;
    for (int a = 0; a < 3; ++a) {
      for (int b = a; b < 3; ++b, ++pair) {
        for (int i = 0; i < 27; ++i) {
          for (int j = 0; j < 27; ++j) {
            k(3 * i + a, 3 * j + b) = blocks.block(pair)[CellElasticity::Blocks::stride * i + j];
            k(3 * j + b, 3 * i + a) = k(3 * i + a, 3 * j + b);
          }
        }
      }
    }
    return k;
  }

  const materials::Material material = GetParam().material;
  dealii::Triangulation<3> mesh;
  CellIntegrals cell;
  NodalVector position;
  CellElasticity elasticity;
  CellElasticity::Blocks blocks;
  ElementMatrices::CellMatrix stiffness;
};

INSTANTIATE_TEST_SUITE_P(Laws, Elasticity, testing::ValuesIn(all_laws()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(Elasticity, ForceIsTheDerivativeOfEnergy) {
  const NodalVector u = random(1, 0.02), h = random(2, 1.);
  const double slope = force(u).dot(h);
  const auto error = [&](const double step) {
    return std::abs((energy(u + step * h) - energy(u - step * h)) / (2. * step) - slope);
  };
  EXPECT_NEAR(std::log2(error(1e-3) / error(5e-4)), 2., 0.1);
  EXPECT_LT(error(1e-4), 1e-2 * std::abs(slope));
}

TEST_P(Elasticity, TangentIsTheDerivativeOfForce) {
  const NodalVector u = random(3, 0.02), h = random(4, 1.);
  const NodalVector slope = tangent(u) * h;
  const auto error = [&](const double step) {
    return ((force(u + step * h) - force(u - step * h)) / (2. * step) - slope).norm();
  };
  EXPECT_NEAR(std::log2(error(1e-3) / error(5e-4)), 2., 0.1);
  EXPECT_LT(error(1e-4), 1e-2 * slope.norm());
}

// Only one triangle of pairs is computed; the diagonal ones must be symmetric by themselves.
TEST_P(Elasticity, TangentIsSymmetric) {
  tangent(random(5, 0.02));
  for (const int pair : {0, 3, 5}) {
    for (int i = 0; i < 27; ++i) {
      for (int j = 0; j < i; ++j) {
        const double* block = blocks.block(pair);
        const double above = block[CellElasticity::Blocks::stride * j + i];
        const double below = block[CellElasticity::Blocks::stride * i + j];
        ASSERT_NEAR(above, below, 1e-12 * stiffness.norm());
      }
    }
  }
}

TEST_P(Elasticity, TangentAtRestIsTheStiffness) {
  EXPECT_EQ((tangent(NodalVector::Zero()) - stiffness).norm(), 0.);
}

TEST_P(Elasticity, SmallForcesFollowTheLinearModelToAllDigits) {
  const NodalVector u = random(6, 1.);
  CellElasticity::Nodal f;
  elasticity.force_of_linear_model(cell, material, nodal(u), f);
  const NodalVector linear = Eigen::Map<const NodalVector>(f.data());
  EXPECT_LT((linear - stiffness * u).norm(), 1e-13 * linear.norm());
  for (const double size : {1e-10, 1e-12, 1e-14}) {
    EXPECT_LT((force(size * u) / size - linear).norm(), 1e3 * size * linear.norm());
  }
}

TEST_P(Elasticity, ARotationStoresNothingAndTurnsTheForces) {
  const Eigen::Matrix3d q =
      Eigen::AngleAxisd(2.1, Eigen::Vector3d(1., -2., 0.5).normalized()).toRotationMatrix();
  EXPECT_LT(force(affine(q)).norm(), 1e-12 * stiffness.norm());
  const NodalVector u = random(7, 0.02);
  NodalVector turned, expected;
  const NodalVector f = force(u);
  for (int n = 0; n < 27; ++n) {
    const auto at = 3 * n;
    turned.segment<3>(at) = q * (position + u).segment<3>(at) - position.segment<3>(at);
    expected.segment<3>(at) = q * f.segment<3>(at);
  }
  EXPECT_NEAR(energy(turned) / energy(u), 1., 1e-9);
  EXPECT_LT((force(turned) - expected).norm(), 1e-10 * expected.norm());
}

TEST_P(Elasticity, ForcesAndTheirMomentsBalanceInTheDeformedState) {
  const NodalVector u = random(8, 0.02), f = force(u);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  for (int n = 0; n < 27; ++n) {
    const Eigen::Vector3d x = (position + u).segment<3>(3 * n);
    sum += f.segment<3>(3 * n);
    moment += x.cross(f.segment<3>(3 * n).eval());
  }
  EXPECT_LT(sum.norm(), 1e-13 * f.norm());
  EXPECT_LT(moment.norm(), 1e-13 * f.norm());
}

TEST_P(Elasticity, AnAffineDeformationStoresTheEnergyOfTheLaw) {
  Eigen::Matrix3d f;
  f << 1.05, 0.1, 0., -0.04, 0.93, 0.02, 0.03, 0., 1.01;
  const Eigen::Matrix3d c = f.transpose() * f;
  materials::Strain e;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) e[i][j] = 0.5 * (c(i, j) - (i == j ? 1. : 0.));
  }
  const double density =
      std::visit([&](const auto& law) { return law.energy(e); }, material.isochoric) +
      material.volumetric.energy(f.determinant() - 1.);
  double volume = 0.;
  for (const double w : cell.weight) volume += w;
  EXPECT_NEAR(energy(affine(f)), density * volume, 1e-11 * density * volume);
}

TEST_P(Elasticity, ACellTurnedInsideOutHasNoEnergy) {
  EXPECT_TRUE(std::isnan(energy(affine(Eigen::Vector3d(1., 1., -0.5).asDiagonal()))));
  // C = F^T F of two turned directions is that of a deformation; det F > 0 it is.
  EXPECT_FALSE(std::isnan(energy(affine(Eigen::Vector3d(1., -1., -1.).asDiagonal()))));
}

}  // namespace
}  // namespace vibrissa::fem
