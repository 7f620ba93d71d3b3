// Based on: Botsch, Kobbelt, "A Remeshing Approach to Multiresolution Modeling", 2004 (split,
// collapse, flip, relax); Dunyach, Vanderhaeghe, Barthe, Botsch, "Adaptive Remeshing for Real-Time Mesh
// Deformation", 2013 (edge lengths from curvature, weighted relaxation).
#include "make_assets/remesh.h"

#include "make_assets/editable_mesh.h"

#include <algorithm>
#include <vector>

namespace vsplit::assets {

namespace {

using Edge = EditableMesh::Edge;

class Remesher
{
public:
    Remesher(const IndexedMesh& mesh, const TargetSurface& surface, const RemeshOptions& options)
        : mesh_(mesh), surface_(surface), options_(options)
    {
    }

    IndexedMesh run()
    {
        for (int round = 0; round < options_.rounds; ++round)
        {
            find_lengths();
            split_long_edges();
            collapse_short_edges();
            flip_for_valence();
            relax();
        }
        return mesh_.compact();
    }

private:
    // Sets lengths_: the edge length that keeps the chord error where the surface bends as it does
    // round the vertex. A chord of length l is l^2 k / 8 away from a circle of curvature k.
    void find_lengths()
    {
        std::vector<Vector3> normals(mesh_.vertex_count());
        for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v)
        {
            if (mesh_.is_alive(v))
            {
                normals[v] = surface_.normal(mesh_.position(v));
            }
        }
        // Normals turn by the root of (k1^2 + k2^2) / 2 a unit of length, on average over directions.
        const auto edges = mesh_.edges();
        std::vector<double> turns(mesh_.vertex_count(), 0.0);
        std::vector<double> squares(mesh_.vertex_count(), 0.0);
        for (const Edge& edge : edges)
        {
            const Vector3 turn = normals[edge.first] - normals[edge.second];
            const Vector3 step = mesh_.position(edge.first) - mesh_.position(edge.second);
            for (const std::uint32_t v : {edge.first, edge.second})
            {
                turns[v] += dot(turn, turn);
                squares[v] += dot(step, step);
            }
        }
        lengths_.assign(mesh_.vertex_count(), options_.longest_edge);
        for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v)
        {
            const double curvature = std::sqrt(2.0 * turns[v] / std::max(squares[v], 1e-18));
            const double wanted = std::sqrt(8.0 * options_.chord_error / std::max(curvature, 1e-9));
            lengths_[v] = std::clamp(wanted, options_.shortest_edge, options_.longest_edge);
        }
        // Lengths may grow by half an edge's length along it, else large triangles meet small ones.
        for (int sweep = 0; sweep < 4; ++sweep)
        {
            for (const Edge& edge : edges)
            {
                const double slack = 0.5 * mesh_.edge_length(edge);
                double& a = lengths_[edge.first];
                double& b = lengths_[edge.second];
                a = std::min(a, b + slack);
                b = std::min(b, a + slack);
            }
        }
    }

    // An edge's length in proportion to the wanted one.
    [[nodiscard]] double proportion(const Edge& edge) const
    {
        return 2.0 * mesh_.edge_length(edge) / (lengths_[edge.first] + lengths_[edge.second]);
    }

    [[nodiscard]] std::vector<Edge> edges_by_length() const
    {
        auto edges = mesh_.edges();
        std::vector<std::pair<double, Edge>> keyed;
        keyed.reserve(edges.size());
        for (const Edge& edge : edges)
        {
            keyed.emplace_back(proportion(edge), edge);
        }
        std::sort(keyed.begin(), keyed.end());
        std::transform(keyed.begin(), keyed.end(), edges.begin(), [](const auto& entry) {
            return entry.second;
        });
        return edges;
    }

    void split_long_edges()
    {
        auto edges = edges_by_length();
        std::reverse(edges.begin(), edges.end());
        for (const Edge& edge : edges)
        {
            Edge sides;
            if (!mesh_.opposite(edge, sides) || proportion(edge) < 4.0 / 3.0)
            {
                continue;
            }
            const Vector3 middle = (mesh_.position(edge.first) + mesh_.position(edge.second)) * 0.5;
            if (mesh_.split(edge, surface_.project(middle)))
            {
                lengths_.push_back(0.5 * (lengths_[edge.first] + lengths_[edge.second]));
            }
        }
    }

    void collapse_short_edges()
    {
        for (const Edge& edge : edges_by_length())
        {
            if (!mesh_.is_alive(edge.first) || !mesh_.is_alive(edge.second) ||
                proportion(edge) > 4.0 / 5.0)
            {
                continue;
            }
            const bool locked = mesh_.is_boundary(edge.first) || mesh_.is_boundary(edge.second);
            const bool swap = mesh_.is_boundary(edge.second);
            const std::uint32_t kept = swap ? edge.second : edge.first;
            const std::uint32_t removed = swap ? edge.first : edge.second;
            const Vector3 middle = (mesh_.position(kept) + mesh_.position(removed)) * 0.5;
            const Vector3 position = locked ? mesh_.position(kept) : surface_.project(middle);
            if (!makes_long_edge(kept, removed, position))
            {
                mesh_.collapse(kept, removed, position);
            }
        }
    }

    [[nodiscard]] bool makes_long_edge(
        std::uint32_t kept, std::uint32_t removed, const Vector3& position
    ) const
    {
        const auto too_long = [&](std::uint32_t v) {
            const double wanted = 0.5 * (lengths_[v] + lengths_[kept]);
            return length(mesh_.position(v) - position) > 4.0 / 3.0 * wanted;
        };
        const auto near_kept = mesh_.neighbours(kept);
        const auto near_removed = mesh_.neighbours(removed);
        return std::any_of(near_kept.begin(), near_kept.end(), too_long) ||
               std::any_of(near_removed.begin(), near_removed.end(), too_long);
    }

    void flip_for_valence()
    {
        const auto excess = [this](std::uint32_t v, int change) {
            const int wanted = mesh_.is_boundary(v) ? 3 : 6;
            const int off = static_cast<int>(mesh_.faces(v).size()) + change - wanted;
            return off * off;
        };
        for (const Edge& edge : mesh_.edges())
        {
            Edge sides;
            if (!mesh_.opposite(edge, sides))
            {
                continue;
            }
            const auto cost = [&](int turned) {
                return excess(edge.first, -turned) + excess(edge.second, -turned) +
                       excess(sides.first, turned) + excess(sides.second, turned);
            };
            if (cost(1) < cost(0))
            {
                mesh_.flip(edge);
            }
        }
    }

    void relax()
    {
        std::vector<Vector3> moved(mesh_.vertex_count());
        for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v)
        {
            moved[v] = mesh_.position(v);
            if (mesh_.is_alive(v) && !mesh_.is_boundary(v))
            {
                moved[v] = relaxed(v);
            }
        }
        for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v)
        {
            mesh_.move(v, moved[v]);
        }
    }

    // Towards the centre of the star, every face weighted by its area over its wanted area.
    [[nodiscard]] Vector3 relaxed(std::uint32_t vertex) const
    {
        Vector3 sum;
        double weights = 0.0;
        for (const std::uint32_t face : mesh_.faces(vertex))
        {
            const auto [a, b, c] = mesh_.triangle(face);
            const double wanted = lengths_[a] + lengths_[b] + lengths_[c];
            const double weight = length(mesh_.area_normal(face)) / (wanted * wanted);
            const Vector3 corners = mesh_.position(a) + mesh_.position(b) + mesh_.position(c);
            sum = sum + corners * (weight / 3.0);
            weights += weight;
        }
        const Vector3& here = mesh_.position(vertex);
        const Vector3 shift = sum * (1.0 / weights) - here;
        const Vector3 normal = surface_.normal(here);
        return surface_.project(here + shift - normal * dot(shift, normal));
    }

    EditableMesh mesh_;
    const TargetSurface& surface_;
    RemeshOptions options_;
    std::vector<double> lengths_;  // wanted edge length at every vertex
};

}  // namespace

TargetSurface surface_of(const Field& field, double step)
{
    const auto gradient = [field, step](const Vector3& p) {
        const auto slope = [&](const Vector3& d) { return field(p + d) - field(p - d); };
        const Vector3 differences{slope({step, 0, 0}), slope({0, step, 0}), slope({0, 0, step})};
        return differences * (0.5 / step);
    };
    TargetSurface surface;
    surface.normal = [gradient](const Vector3& p) { return unit(gradient(p)); };
    surface.project = [field, gradient, step](const Vector3& point) {
        Vector3 p = point;
        for (int iteration = 0; iteration < 4; ++iteration)  // Newton along the gradient
        {
            const double value = field(p);
            if (std::abs(value) < 1e-3 * step)
            {
                break;
            }
            const Vector3 slope = gradient(p);
            p = p - slope * (value / std::max(dot(slope, slope), 0.01));
        }
        return p;
    };
    return surface;
}

IndexedMesh remesh(
    const IndexedMesh& mesh, const TargetSurface& surface, const RemeshOptions& options
)
{
    return Remesher(mesh, surface, options).run();
}

}  // namespace vsplit::assets
