// Based on: Wang, Yang, "3D Models Simplification Algorithm for Mobile Devices", equations 1-16, and
// for the parametrisation over a base surface: Ma, Kruth, "Parameterization of randomly measured
// points for least squares fitting of B-spline curves and surfaces", 1995.
//
// Our reading, for the paper's full text was not at hand: what it fits (a bicubic uniform B-spline
// surface of 16 control points, by least squares, over the adaptive neighbourhood projected on a base
// surface) and the order of its equations are known, their exact wording is not. The numbers below
// follow that order: 1 basis, 2 surface, 3-4 parametrisation, 5-7 least squares, 8-9 derivatives,
// 10-12 normal and fundamental forms, 13-14 Gaussian and mean curvature, 15-16 principal and absolute
// curvature (10-16 stand in local_fit.cpp, which both fits share). Ours by choice:
// * The base surface is the tangent plane of the vertex.
// * 17 to 26 points hardly determine 16 control points, so a weak Tikhonov term is added. It acts on
//   third differences of the control net, which vanish for every quadratic surface: it smooths
//   noise without flattening the surface. Its weight is the one of least error on a noisy torus: a
//   thousand times less doubles what noise does to the result, ten times more loses the bicubic
//   terms and with them the advantage over the quadric fit on smooth surfaces.
// * Where fewer than 16 points exist, or they nearly lie on a line, the quadric fit takes over.
#include "precompute/curvature.h"
#include "precompute/local_fit.h"
#include "precompute/parallel_ranges.h"
#include "precompute/vertex_neighbourhood.h"

#include <Eigen/Cholesky>

namespace vsplit::precompute {

namespace {

using Vector4 = Eigen::Vector4d;
using Vector16 = Eigen::Matrix<double, 16, 1>;
using Matrix16 = Eigen::Matrix<double, 16, 16>;
using ControlPoints = Eigen::Matrix<double, 16, 3>;  // control point (i, j) in row 4 i + j

constexpr std::size_t kLeastFitted = 15;    // and the vertex itself: as many as control points
constexpr double kSmoothing = 1e-6;         // weight of a squared third difference, per point
constexpr double kLeastPivotRatio = 1e-12;  // below, the normal equations are near singular

// eq. 1: the uniform cubic B-spline basis on [0, 1].
Vector4 basis(double t)
{
    const double s = 1.0 - t;
    return Vector4(
               s * s * s,
               3.0 * t * t * t - 6.0 * t * t + 4.0,
               -3.0 * t * t * t + 3.0 * t * t + 3.0 * t + 1.0,
               t * t * t
           ) /
           6.0;
}

// eq. 8: its first derivative.
Vector4 basis_first(double t)
{
    const double s = 1.0 - t;
    return Vector4(-s * s, 3.0 * t * t - 4.0 * t, -3.0 * t * t + 2.0 * t + 1.0, t * t) / 2.0;
}

// eq. 9: its second derivative.
Vector4 basis_second(double t)
{
    return {1.0 - t, 3.0 * t - 2.0, 1.0 - 3.0 * t, t};
}

// eq. 2: the weights of the 16 control points at (u, v), from the weights along u and along v.
Vector16 tensor(const Vector4& along_u, const Vector4& along_v)
{
    Vector16 weights;
    for (int i = 0; i < 4; ++i)
    {
        weights.segment<4>(4 * i) = along_u[i] * along_v;
    }
    return weights;
}

// The sum of squared third differences of a control net, u u u, u u v, u v v and v v v, as a matrix.
Matrix16 third_difference_energy()
{
    // Finite-difference stencils of order 0 to 3, in the first order + 1 places.
    const std::array<Vector4, 4> stencils{
        Vector4(1, 0, 0, 0), Vector4(-1, 1, 0, 0), Vector4(1, -2, 1, 0), Vector4(-1, 3, -3, 1)};
    const auto shifted = [](const Vector4& stencil, int shift) {
        Vector4 result = Vector4::Zero();
        result.tail(4 - shift) = stencil.head(4 - shift);
        return result;
    };
    Matrix16 energy = Matrix16::Zero();
    for (int order_u = 0; order_u <= 3; ++order_u)
    {
        const int order_v = 3 - order_u;
        for (int place = 0; place < (4 - order_u) * (4 - order_v); ++place)
        {
            const Vector16 difference = tensor(
                shifted(stencils[static_cast<std::size_t>(order_u)], place % (4 - order_u)),
                shifted(stencils[static_cast<std::size_t>(order_v)], place / (4 - order_u))
            );
            energy += difference * difference.transpose();
        }
    }
    return energy;
}

// Parameter of a coordinate of the base plane, eqs. 3 and 4: the patch's |coordinates| are at most 1
// and span the parameter square, the vertex lies in its centre.
double parameter(double coordinate)
{
    return 0.5 + 0.5 * coordinate;
}

// |k1| + |k2| in 1 / patch.radius, or a negative number when the points do not determine a surface.
double bspline_fit(const LocalPatch& patch, const Matrix16& smoothing)
{
    const Vector4 centre = basis(0.5);
    const Vector16 centre_weights = tensor(centre, centre);
    // eqs. 5-7: minimise sum |S(u_k, v_k) - p_k|^2, hence (B^T B) C = B^T P. The vertex itself is one
    // of the points and, as the origin, adds nothing to the right-hand side.
    Matrix16 normal_matrix = smoothing * (kSmoothing * static_cast<double>(patch.point_count + 1));
    normal_matrix.noalias() += centre_weights * centre_weights.transpose();
    ControlPoints right = ControlPoints::Zero();
    for (std::size_t k = 0; k < patch.point_count; ++k)
    {
        const Eigen::Vector3d& point = patch.points[k];
        const Vector16 row = tensor(basis(parameter(point.x())), basis(parameter(point.y())));
        normal_matrix.noalias() += row * row.transpose();
        right.noalias() += row * point.transpose();
    }
    const Eigen::LDLT<Matrix16> factors(normal_matrix);
    const Vector16 pivots = factors.vectorD();
    if (!(pivots.minCoeff() > kLeastPivotRatio * pivots.maxCoeff()))
    {
        return -1.0;
    }
    const ControlPoints control = factors.solve(right);
    const Vector4 first = basis_first(0.5);
    const Vector4 second = basis_second(0.5);
    return absolute_curvature(
        {.u = control.transpose() * tensor(first, centre),
         .v = control.transpose() * tensor(centre, first),
         .uu = control.transpose() * tensor(second, centre),
         .uv = control.transpose() * tensor(first, first),
         .vv = control.transpose() * tensor(centre, second)}
    );
}

}  // namespace

std::vector<float> bspline_curvature(const HalfEdgeMesh& mesh, unsigned threads)
{
    const auto vertex_count = static_cast<std::uint32_t>(mesh.n_vertices());
    std::vector<float> curvature(vertex_count, 0.0F);
    const auto normals = vertex_normals(mesh);
    const Matrix16 smoothing = third_difference_energy();
    parallel_ranges(vertex_count, threads, [&](std::uint32_t begin, std::uint32_t end) {
        NeighbourhoodSearch search(mesh);
        LocalPatch patch;
        for (std::uint32_t v = begin; v < end; ++v)
        {
            if (!make_patch(mesh, normals, v, search.adaptive(v), patch))
            {
                continue;
            }
            double fitted =
                patch.point_count >= kLeastFitted ? bspline_fit(patch, smoothing) : -1.0;
            if (!(fitted >= 0.0))
            {
                fitted = quadric_fit(patch);
            }
            curvature[v] = to_curvature(fitted, patch.radius);
        }
    });
    return curvature;
}

}  // namespace vsplit::precompute
