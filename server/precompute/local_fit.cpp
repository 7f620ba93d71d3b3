// Based on: do Carmo, "Differential Geometry of Curves and Surfaces", 1976, section 3-3 (curvatures
// from the fundamental forms); Goldfeather, Interrante, "A Novel Cubic-Order Algorithm for
// Approximating Principal Direction Vectors", 2004, section 3 (the quadric height fit).
// The equation numbers 10 to 16 are those of Wang, Yang; see bspline_curvature.cpp.
#include "precompute/local_fit.h"

#include "precompute/vertex_neighbourhood.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vsplit::precompute {

namespace {

Eigen::Vector3d point_of(const HalfEdgeMesh& mesh, std::uint32_t vertex)
{
    return Eigen::Map<const Eigen::Vector3d>(mesh.point(vertex_handle(vertex)).data());
}

// A unit vector across `normal` that turns with the model, or any one if `direction` is along it.
Eigen::Vector3d tangent_towards(const Eigen::Vector3d& normal, const Eigen::Vector3d& direction)
{
    const Eigen::Vector3d flat = direction - normal * normal.dot(direction);
    if (flat.squaredNorm() > 1e-6 * direction.squaredNorm())
    {
        return flat.normalized();
    }
    const bool mostly_x = std::abs(normal.x()) > 0.7;
    return normal.cross(mostly_x ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX())
        .normalized();
}

}  // namespace

std::vector<Eigen::Vector3d> vertex_normals(const HalfEdgeMesh& mesh)
{
    std::vector<Eigen::Vector3d> normals(mesh.n_vertices(), Eigen::Vector3d::Zero());
    for (const auto face : mesh.faces())
    {
        std::array<std::uint32_t, 3> corners{};
        std::transform(mesh.cfv_begin(face), mesh.cfv_end(face), corners.begin(), [](auto vertex) {
            return static_cast<std::uint32_t>(vertex.idx());
        });
        const auto [a, b, c] = corners;
        const Eigen::Vector3d corner = point_of(mesh, a);
        const Eigen::Vector3d twice_area =
            (point_of(mesh, b) - corner).cross(point_of(mesh, c) - corner);
        normals[a] += twice_area;
        normals[b] += twice_area;
        normals[c] += twice_area;
    }
    for (Eigen::Vector3d& normal : normals)
    {
        const double length = normal.stableNorm();
        normal = length > 0.0 && std::isfinite(length) ? Eigen::Vector3d(normal / length)
                                                       : Eigen::Vector3d::Zero();
    }
    return normals;
}

bool make_patch(
    const HalfEdgeMesh& mesh,
    const std::vector<Eigen::Vector3d>& normals,
    std::uint32_t vertex,
    std::span<const std::uint32_t> neighbours,
    LocalPatch& patch
)
{
    const Eigen::Vector3d origin = point_of(mesh, vertex);
    const Eigen::Vector3d& normal = normals[vertex];
    double squared_radius = 0.0;
    patch.point_count = std::min(neighbours.size(), LocalPatch::kMostPoints);
    for (std::size_t i = 0; i < patch.point_count; ++i)
    {
        patch.points[i] = point_of(mesh, neighbours[i]) - origin;
        squared_radius = std::max(squared_radius, patch.points[i].squaredNorm());
    }
    patch.radius = std::sqrt(squared_radius);
    if (!(patch.radius > 0.0) || !std::isfinite(patch.radius) || normal.isZero(0.5))
    {
        return false;
    }
    const Eigen::Vector3d towards = point_of(mesh, first_neighbour(mesh, vertex));
    const Eigen::Vector3d x_axis = tangent_towards(normal, towards - origin);
    const Eigen::Vector3d y_axis = normal.cross(x_axis);
    const double scale = 1.0 / patch.radius;
    for (std::size_t i = 0; i < patch.point_count; ++i)
    {
        const Eigen::Vector3d offset = patch.points[i] * scale;
        patch.points[i] = {x_axis.dot(offset), y_axis.dot(offset), normal.dot(offset)};
    }
    return true;
}

double absolute_curvature(const SurfaceDerivatives& d)
{
    const Eigen::Vector3d across = d.u.cross(d.v);
    const double area = across.norm();
    if (!(area > 1e-9))
    {
        return 0.0;
    }
    const Eigen::Vector3d normal = across / area;                                   // eq. 10
    const double E = d.u.dot(d.u), F = d.u.dot(d.v), G = d.v.dot(d.v);              // eq. 11
    const double L = normal.dot(d.uu), M = normal.dot(d.uv), N = normal.dot(d.vv);  // eq. 12
    const double determinant = area * area;                 // E G - F F, without its cancellation
    const double gaussian = (L * N - M * M) / determinant;  // eq. 13
    const double mean = (E * N - 2.0 * F * M + G * L) / (2.0 * determinant);  // eq. 14
    const double spread = std::sqrt(std::max(0.0, mean * mean - gaussian));
    return std::abs(mean + spread) + std::abs(mean - spread);  // eqs. 15, 16
}

double quadric_fit(const LocalPatch& patch)
{
    using Vector5 = Eigen::Matrix<double, 5, 1>;
    using Matrix5 = Eigen::Matrix<double, 5, 5>;
    // z = a x^2/2 + b x y + c y^2/2 + d x + e y. The Tikhonov term weighs the Hessian by its
    // Frobenius norm (b counts twice), hence it does not prefer a direction of the frame.
    constexpr double kRidge = 1e-7;
    Matrix5 normal_matrix = (kRidge * (Vector5() << 1, 2, 1, 1, 1).finished()).asDiagonal();
    Vector5 right = Vector5::Zero();
    for (std::size_t i = 0; i < patch.point_count; ++i)
    {
        const double x = patch.points[i].x();
        const double y = patch.points[i].y();
        const Vector5 row = (Vector5() << 0.5 * x * x, x * y, 0.5 * y * y, x, y).finished();
        normal_matrix.noalias() += row * row.transpose();
        right += row * patch.points[i].z();
    }
    const Vector5 fit = normal_matrix.llt().solve(right);
    return absolute_curvature(
        {.u = {1.0, 0.0, fit[3]},
         .v = {0.0, 1.0, fit[4]},
         .uu = {0.0, 0.0, fit[0]},
         .uv = {0.0, 0.0, fit[1]},
         .vv = {0.0, 0.0, fit[2]}}
    );
}

float to_curvature(double fitted, double radius)
{
    // Below this a fit sees nothing but the rounding of the coordinates: the surface is flat.
    constexpr double kRounding = 1e-10;
    const double value = fitted / radius;
    if (!std::isfinite(value) || fitted < kRounding)
    {
        return 0.0F;
    }
    return static_cast<float>(
        std::clamp(value, 0.0, static_cast<double>(std::numeric_limits<float>::max()))
    );
}

}  // namespace vsplit::precompute
