#pragma once

#include "precompute/encode_model.h"
#include "report.h"

#include <cstddef>
#include <string>
#include <vector>

namespace vsplit::tools {

/// The command line of `vsplit encode`.
struct EncodeArguments
{
    std::string input;
    std::string output;
    std::string metric;
    std::string json;
    std::string companions;  ///< File for the names of what the input refers to; empty: none.
    std::vector<std::string> keep_regions;  ///< As they were written.
    std::string keep_mask;
    std::vector<std::string> drop;  ///< Kinds of attributes, or "materials".
    precompute::ModelOptions options;
    bool attributes = true;
    bool quiet = false;
};

/// Seconds that stages of the tool took.
struct ToolSeconds
{
    double read = 0.0;
    double repair = 0.0;
    double encode = 0.0;
    double write = 0.0;
};

/// An encode, as far as it got.
struct EncodeOutcome
{
    std::size_t input_vertices = 0;
    std::size_t input_faces = 0;
    std::size_t kept_vertices = 0;  ///< Marked by --keep-region and --keep-mask.
    precompute::RepairedModel model;
    std::vector<std::string> dropped;  ///< What the input has and the stream has not, in words.
    precompute::EncodedModel encoded;
    ToolSeconds seconds;
};

/// Describes an encode for programs.
[[nodiscard]] Json outcome_json(const EncodeArguments& arguments, const EncodeOutcome& outcome);

/// Says what was read and repaired.
void print_input(const EncodeArguments& arguments, const EncodeOutcome& outcome);

/// Says what came out.
void print_outcome(const EncodeArguments& arguments, const EncodeOutcome& outcome);

}  // namespace vsplit::tools
