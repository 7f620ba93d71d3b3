#include "commands.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <malloc.h>
#include <string>

namespace {

constexpr int kUsageStatus = 2;

/// Prints an error as exactly one line, whatever is in it.
int report(const vsplit::Error& error)
{
    std::string line = "vsplit: " + vsplit::describe(error);
    std::replace_if(
        line.begin(),
        line.end(),
        [](char letter) { return static_cast<unsigned char>(letter) < ' '; },
        '?'
    );
    std::fprintf(stderr, "%s\n", line.c_str());
    return vsplit::exit_status(error.code);
}

int run(int argc, char** argv)
{
    CLI::App app("Turns a triangle mesh into one file in which every prefix is a usable mesh.");
    app.name("vsplit");
    app.set_version_flag("--version", "vsplit " VSPLIT_VERSION);
    app.require_subcommand(1);
    vsplit::Result<void> result;
    vsplit::tools::add_encode_command(app, result);
    vsplit::tools::add_inspect_command(app, result);
    vsplit::tools::add_decode_command(app, result);
    vsplit::tools::add_verify_command(app, result);
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        return app.exit(error) == 0 ? 0 : kUsageStatus;
    }
    return result ? 0 : report(result.error());
}

}  // namespace

int main(int argc, char** argv)
{
#ifdef M_MMAP_THRESHOLD
    // Large blocks go back to the system when they are freed. Without a fixed threshold the C library
    // raises it and keeps them: a fifth more memory at the peak of an encode.
    ::mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
    try
    {
        return run(argc, argv);
    }
    catch (const std::bad_alloc&)
    {
        return report({vsplit::ErrorCode::Internal, "there is not enough memory", 0});
    }
    catch (const std::exception& error)
    {
        return report({vsplit::ErrorCode::Internal, error.what(), 0});
    }
}
