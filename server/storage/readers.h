#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <semaphore>
#include <vector>

#include "server/storage/connection.h"

namespace penumbra::server::storage {

/// Reading connections, opened when they are first needed and kept. Who waits for one gets it in
/// the order of asking: under a crowd, a free-for-all would make some wait for many times the
/// median. Thread-safe.
class Readers {
 public:
  using Open = std::function<std::unique_ptr<Connection>()>;

  /// At most `most` connections, made by `open`.
  Readers(Open open, std::size_t most);

  /// A connection for the length of a block.
  class Lease {
   public:
    /// Waits for a connection. Throws what `open` throws.
    explicit Lease(Readers& owner);
    ~Lease();
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    Connection& operator*() { return *connection; }

   private:
    Readers& owner;
    std::unique_ptr<Connection> connection;
  };

  /// Those that wait now.
  std::size_t waiting() const;

 private:
  struct Waiter {
    std::binary_semaphore served{0};
    std::unique_ptr<Connection> connection;  ///< empty: it may open one
  };

  std::unique_ptr<Connection> take();
  /// Gives a connection, or with none the right to open one, to the next that waits.
  void give(std::unique_ptr<Connection> connection);

  const Open open;
  const std::size_t most;
  mutable std::mutex mutex;
  std::vector<std::unique_ptr<Connection>> idle;
  std::size_t count = 0;  ///< idle ones, those in use and those being opened
  std::deque<Waiter*> queue;
};

}  // namespace penumbra::server::storage
