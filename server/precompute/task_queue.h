#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace vsplit::precompute {

/// Runs tasks one after another, in the order in which they came, on a thread of its own. What is
/// queued is run before the destructor returns. Tasks must not throw. run() and wait() are for one
/// thread only.
class TaskQueue
{
public:
    /// Starts the thread.
    TaskQueue() : worker_([this] { work(); }) {}

    TaskQueue(const TaskQueue&) = delete;
    TaskQueue& operator=(const TaskQueue&) = delete;

    ~TaskQueue()
    {
        run({});  // says that no more will come
    }

    /// Queues a task; an empty one ends the queue.
    void run(std::function<void()> task)
    {
        {
            const std::scoped_lock lock(mutex_);
            tasks_.push_back(std::move(task));
        }
        changed_.notify_all();
    }

    /// Returns when all tasks are done; what they wrote may be read then.
    void wait()
    {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return tasks_.empty(); });
    }

private:
    void work()
    {
        std::unique_lock lock(mutex_);
        while (true)
        {
            changed_.wait(lock, [this] { return !tasks_.empty(); });
            if (!tasks_.front())
            {
                return;
            }
            lock.unlock();
            tasks_.front()();  // stays in front, so that wait() knows of it
            lock.lock();
            tasks_.pop_front();
            changed_.notify_all();
        }
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> tasks_;
    std::jthread worker_;  // last, so that it starts when all is there and ends before
};

}  // namespace vsplit::precompute
