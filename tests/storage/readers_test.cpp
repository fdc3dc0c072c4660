#include "server/storage/readers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace penumbra::server::storage {
namespace {

std::unique_ptr<Connection> in_memory() {
  return std::make_unique<Connection>(":memory:", SQLite::OPEN_READWRITE, 0);
}

void wait_for_waiting(const Readers& readers, std::size_t count) {
  while (readers.waiting() < count) std::this_thread::yield();
}

TEST(ReadersTest, ServesInTheOrderOfAsking) {
  Readers readers(in_memory, 1);
  std::mutex mutex;
  std::vector<int> order;
  std::vector<std::thread> threads;
  {
    Readers::Lease held(readers);
    for (int i = 0; i < 5; ++i) {
      threads.emplace_back([&, i] {
        Readers::Lease lease(readers);
        const std::lock_guard lock(mutex);
        order.push_back(i);
      });
      wait_for_waiting(readers, static_cast<std::size_t>(i) + 1);
    }
  }
  // Who had it asks again at once and comes last all the same.
  {
    Readers::Lease again(readers);
    const std::lock_guard lock(mutex);
    order.push_back(5);
  }
  for (auto& thread : threads) thread.join();
  EXPECT_THAT(order, testing::ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(ReadersTest, OpensNoMoreThanItMay) {
  std::atomic<int> opened = 0;
  Readers readers(
      [&] {
        ++opened;
        return in_memory();
      },
      3);
  std::vector<std::thread> threads;
  for (int i = 0; i < 16; ++i)
    threads.emplace_back([&] {
      for (int k = 0; k < 50; ++k)
        EXPECT_EQ((*Readers::Lease(readers)).execAndGet("SELECT 7").getInt(), 7);
    });
  for (auto& thread : threads) thread.join();
  EXPECT_LE(opened, 3);
  EXPECT_GE(opened, 1);
}

TEST(ReadersTest, AFailureToOpenLeavesItsPlaceToTheNext) {
  std::atomic<bool> broken = true;
  Readers readers(
      [&]() -> std::unique_ptr<Connection> {
        if (broken) throw std::runtime_error("no descriptors");
        return in_memory();
      },
      1);
  EXPECT_THROW(Readers::Lease lease(readers), std::runtime_error);
  broken = false;
  Readers::Lease held(readers);
  EXPECT_EQ((*held).execAndGet("SELECT 7").getInt(), 7);
}

TEST(ReadersTest, WhoWaitsForAFailingOpenerOpensItself) {
  std::atomic<int> calls = 0;
  Readers* pool = nullptr;
  Readers readers(
      [&]() -> std::unique_ptr<Connection> {
        if (++calls > 1) return in_memory();
        wait_for_waiting(*pool, 1);  // the other one asks meanwhile
        throw std::runtime_error("no descriptors");
      },
      1);
  pool = &readers;
  std::thread second([&] {
    while (calls == 0) std::this_thread::yield();
    Readers::Lease lease(readers);
    EXPECT_EQ((*lease).execAndGet("SELECT 7").getInt(), 7);
  });
  EXPECT_THROW(Readers::Lease lease(readers), std::runtime_error);
  second.join();
  EXPECT_EQ(calls, 2);
}

}  // namespace
}  // namespace penumbra::server::storage
