#include "net/model_library.h"

#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <spdlog/spdlog.h>

#include <exception>
#include <optional>
#include <system_error>
#include <utility>

namespace vsplit::net {
namespace {

constexpr std::size_t kOpeningThreads = 2;
constexpr std::size_t kEncodingThreads = 1;
constexpr std::size_t kMaxWaiters = 1024;
constexpr std::size_t kMaxFailures = 1024;

/// Clients learn what went wrong with a file, the log also learns which one it was.
Result<StreamPtr> reported(Result<StreamPtr> result, const std::filesystem::path& path)
{
    if (result)
    {
        return result;
    }
    spdlog::warn("{}: {}", path.string(), describe(result.error()));
    if (result.error().code == ErrorCode::NotFound || result.error().code == ErrorCode::IoError)
    {
        return fail(ErrorCode::IoError, "the server cannot read the model");
    }
    return result;
}

/// Calls back with what `work` returns; an exception on the way (memory, for one) becomes an error.
template <typename Work>
Result<StreamPtr> guarded(Work work)
{
    try
    {
        return work();
    }
    catch (const std::exception& thrown)
    {
        spdlog::error("model library: {}", thrown.what());
        return fail(ErrorCode::IoError, "the server could not prepare the model");
    }
}

}  // namespace

/// Opening files must not wait behind a mesh that takes minutes to encode.
class ModelLibrary::Threads
{
public:
    boost::asio::thread_pool opening{kOpeningThreads};
    boost::asio::thread_pool encoding{kEncodingThreads};
};

ModelLibrary::ModelLibrary(std::filesystem::path root, EncoderSettings encoder)
    : root_(std::move(root)), encoder_(std::move(encoder)), threads_(std::make_unique<Threads>())
{
}

ModelLibrary::~ModelLibrary()
{
    stop();
    // Opening work may hand on to encoding, not the other way round.
    threads_->opening.join();
    threads_->encoding.join();
}

void ModelLibrary::stop()
{
    encoder_.stop();
}

void ModelLibrary::find(std::string name, Done done)
{
    boost::asio::post(threads_->opening, [this, name = std::move(name), done = std::move(done)] {
        find_now(name, done);
    });
}

void ModelLibrary::find_now(const std::string& name, const Done& done)
{
    std::optional<std::filesystem::path> source;
    auto stream = guarded([&]() -> Result<StreamPtr> {
        const auto location = locate_model(root_, name);
        VSPLIT_TRY(location);
        if (location->is_source_mesh)
        {
            source = location->path;
            return StreamPtr();
        }
        return reported(store_.open(location->path), location->path);
    });
    if (source)
    {
        find_source(*source, done);
        return;
    }
    done(std::move(stream));
}

void ModelLibrary::find_source(const std::filesystem::path& source, const Done& done)
{
    const auto target = encoder_.target_of(source);
    if (!target)
    {
        done(tl::unexpected<Error>(target.error()));
        return;
    }
    if (encoder_.is_stale(source, *target))
    {
        spdlog::info("{} refers to files that have changed", source.string());
        forget(*target);
    }
    if (auto cached = open_cached(*target))
    {
        done(std::move(cached));
        return;
    }
    if (join(*target, done))
    {
        boost::asio::post(threads_->encoding, [this, source, target = *target] {
            encode_now(source, target);
        });
    }
}

Result<StreamPtr> ModelLibrary::open_cached(const std::filesystem::path& target)
{
    return guarded([&]() -> Result<StreamPtr> {
        auto stream = store_.open(target);
        if (!stream && stream.error().code != ErrorCode::NotFound)
        {
            spdlog::warn("cache: dropping {}: {}", target.string(), describe(stream.error()));
            std::error_code ignored;
            std::filesystem::remove(target, ignored);
        }
        return stream;
    });
}

void ModelLibrary::forget(const std::filesystem::path& target)
{
    encoder_.forget(target);
    const std::lock_guard lock(mutex_);
    failures_.erase(target);
}

bool ModelLibrary::join(const std::filesystem::path& target, const Done& done)
{
    std::unique_lock lock(mutex_);
    if (const auto failure = failures_.find(target); failure != failures_.end())
    {
        const Error error = failure->second;
        lock.unlock();
        done(tl::unexpected<Error>(error));
        return false;
    }
    const auto [entry, first] = encoding_.try_emplace(target);
    if (entry->second.size() >= kMaxWaiters)
    {
        lock.unlock();
        done(fail(ErrorCode::Overloaded, "too many clients wait for this model"));
        return false;
    }
    entry->second.push_back(done);
    return first;
}

void ModelLibrary::encode_now(
    const std::filesystem::path& source, const std::filesystem::path& target
)
{
    const auto stream = guarded([&] { return encode_and_open(source, target); });
    if (!stream)
    {
        remember(target, stream.error());
    }
    Waiters waiters;
    {
        const std::lock_guard lock(mutex_);
        waiters = std::move(encoding_[target]);
        encoding_.erase(target);
    }
    for (const Done& done : waiters)
    {
        done(stream);
    }
}

Result<StreamPtr> ModelLibrary::encode_and_open(
    const std::filesystem::path& source, const std::filesystem::path& target
)
{
    // A request that looked just before the last encode ended comes here too late.
    if (auto cached = open_cached(target))
    {
        return cached;
    }
    spdlog::info("encoding {}", source.string());
    const auto encoded = encoder_.encode(source, target);
    if (!encoded)
    {
        spdlog::warn("encoding {} failed: {}", source.string(), describe(encoded.error()));
        return tl::unexpected<Error>(encoded.error());
    }
    auto stream = store_.open(target);
    if (!stream)
    {
        spdlog::error("the encoder made a bad {}: {}", target.string(), describe(stream.error()));
        std::error_code ignored;
        std::filesystem::remove(target, ignored);
        return fail(ErrorCode::EncodeFailed, "the encoder made a damaged stream");
    }
    spdlog::info("encoded {} into {}", source.string(), target.string());
    return stream;
}

void ModelLibrary::remember(const std::filesystem::path& target, const Error& error)
{
    if (error.code != ErrorCode::EncodeFailed)
    {
        return;
    }
    const std::lock_guard lock(mutex_);
    if (failures_.size() >= kMaxFailures)
    {
        failures_.clear();
    }
    failures_.emplace(target, error);
}

}  // namespace vsplit::net
