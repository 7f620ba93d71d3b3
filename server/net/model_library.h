#pragma once

#include "core/result.h"
#include "net/model_name.h"
#include "net/source_encoder.h"
#include "net/stream_store.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace vsplit::net {

/// Finds models by name on threads of its own: stream files below the root, and source meshes, which
/// are encoded once however many clients ask. Thread safe.
class ModelLibrary
{
public:
    /// Receives the result of find(), on a thread of the library.
    using Done = std::function<void(Result<StreamPtr>)>;

    /// `root`: absolute, canonical folder; `encoder`: how to treat source meshes.
    ModelLibrary(std::filesystem::path root, EncoderSettings encoder);

    /// As stop(), then waits for the library's threads.
    ~ModelLibrary();
    ModelLibrary(const ModelLibrary&) = delete;
    ModelLibrary& operator=(const ModelLibrary&) = delete;

    /// Looks a model up and calls `done` exactly once; returns at once.
    /// `name`: as received from a client. Errors given to `done`: those of locate_model(),
    /// StreamStore::open() and SourceEncoder; Overloaded when too many wait for one mesh; Cancelled
    /// when the library stops. Messages do not name folders of the server. Safe on untrusted names.
    void find(std::string name, Done done);

    /// Kills running encoders; what waits for them is answered with Cancelled.
    void stop();

private:
    class Threads;
    using Waiters = std::vector<Done>;

    void find_now(const std::string& name, const Done& done);
    void find_source(const std::filesystem::path& source, const Done& done);
    void encode_now(const std::filesystem::path& source, const std::filesystem::path& target);
    [[nodiscard]] Result<StreamPtr> encode_and_open(
        const std::filesystem::path& source, const std::filesystem::path& target
    );
    [[nodiscard]] Result<StreamPtr> open_cached(const std::filesystem::path& target);
    [[nodiscard]] bool join(const std::filesystem::path& target, const Done& done);
    void forget(const std::filesystem::path& target);
    void remember(const std::filesystem::path& target, const Error& error);

    std::filesystem::path root_;
    SourceEncoder encoder_;
    StreamStore store_;
    std::mutex mutex_;
    std::map<std::filesystem::path, Waiters> encoding_;  ///< By target.
    std::map<std::filesystem::path, Error> failures_;  ///< By target; a changed source has another.
    std::unique_ptr<Threads> threads_;                 ///< Last: its threads use all of the above.
};

}  // namespace vsplit::net
