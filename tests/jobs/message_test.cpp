#include "server/jobs/message.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <thread>

namespace penumbra::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

struct TestPipe {
  int ends[2] = {-1, -1};
  TestPipe() { EXPECT_EQ(::pipe2(ends, O_CLOEXEC), 0); }
  ~TestPipe() {
    ::close(ends[0]);
    close_writer();
  }
  void write(const std::string& bytes) {
    ASSERT_EQ(::write(ends[1], bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  void close_writer() {
    if (ends[1] >= 0) ::close(ends[1]);
    ends[1] = -1;
  }
};

steady_clock::time_point soon() {
  return steady_clock::now() + milliseconds(50);
}
steady_clock::time_point late() {
  return steady_clock::now() + std::chrono::seconds(20);
}

TEST(Message, arrives_with_its_files_byte_for_byte) {
  TestPipe pipe;
  Message sent{{{"done", true}}, {{"a", std::string("line\nzero\0end", 13)}, {"b", ""}}};
  sent.blobs["large"] = std::string(300000, 'x');  // more than a pipe holds at once
  std::thread writer([&] {
    write_message(pipe.ends[1], sent);
    write_message(pipe.ends[1], {{{"next", 2}}, {}});
  });
  MessageReader reader(pipe.ends[0]);
  Message received;
  EXPECT_EQ(reader.read(received, late()), Exchange::message);
  EXPECT_EQ(received.body, sent.body);
  EXPECT_EQ(received.blobs, sent.blobs);
  EXPECT_EQ(reader.read(received, late()), Exchange::message);
  EXPECT_EQ(received.body.at("next"), 2);
  EXPECT_TRUE(received.blobs.empty());
  writer.join();
}

TEST(Message, is_waited_for_until_the_deadline_and_no_longer) {
  TestPipe pipe;
  pipe.write("{\"half\":");
  MessageReader reader(pipe.ends[0]);
  Message message;
  EXPECT_EQ(reader.read(message, soon()), Exchange::deadline);
  pipe.write("1}\n");
  EXPECT_EQ(reader.read(message, late()), Exchange::message);
  EXPECT_EQ(message.body.at("half"), 1);
}

TEST(Message, is_given_up_when_asked_to_stop) {
  TestPipe pipe;
  MessageReader reader(pipe.ends[0]);
  Message message;
  EXPECT_EQ(reader.read(message, late(), [] { return true; }), Exchange::stopped);
}

TEST(Message, to_one_that_stopped_reading_is_given_up) {
  TestPipe pipe;
  ASSERT_EQ(::fcntl(pipe.ends[1], F_SETFL, O_NONBLOCK), 0);
  const Message large{{{"task", 1}}, {{"reference", std::string(1 << 20, 'x')}}};
  const auto begin = steady_clock::now();
  EXPECT_EQ(write_message(pipe.ends[1], large, soon(), {}), Exchange::deadline);
  EXPECT_EQ(write_message(pipe.ends[1], large, late(), [] { return true; }), Exchange::stopped);
  EXPECT_LT(steady_clock::now() - begin, std::chrono::seconds(10));
  ::close(pipe.ends[0]);
  std::signal(SIGPIPE, SIG_IGN);
  EXPECT_EQ(write_message(pipe.ends[1], large, late(), {}), Exchange::closed);
  pipe.ends[0] = ::dup(pipe.ends[1]);
}

TEST(Message, to_a_slow_reader_passes_whole) {
  TestPipe pipe;
  ASSERT_EQ(::fcntl(pipe.ends[1], F_SETFL, O_NONBLOCK), 0);
  const Message sent{{{"task", 1}}, {{"reference", std::string(300000, 'x')}}};
  Message received;
  std::thread slow([&] {
    std::this_thread::sleep_for(milliseconds(100));
    MessageReader(pipe.ends[0]).read(received, late());
  });
  EXPECT_EQ(write_message(pipe.ends[1], sent, late(), {}), Exchange::message);
  slow.join();
  EXPECT_EQ(received.blobs, sent.blobs);
}

TEST(Message, that_is_cut_off_is_none) {
  TestPipe pipe;
  pipe.write("{\"blobs\":[{\"name\":\"a\",\"bytes\":10}]}\n12345");
  pipe.close_writer();
  MessageReader reader(pipe.ends[0]);
  Message message;
  EXPECT_EQ(reader.read(message, late()), Exchange::closed);
}

TEST(Message, from_a_stranger_is_told_from_one_of_ours) {
  for (const std::string text :
       {"WARNING: not a conformant driver\n", "[1,2]\n", "{\"blobs\":[{\"name\":1,\"bytes\":2}]}\n",
        "{\"blobs\":[{\"name\":\"a\",\"bytes\":-1}]}\n",
        "{\"blobs\":[{\"name\":\"a\",\"bytes\":18446744073709551615}]}\n"}) {
    TestPipe pipe;
    pipe.write(text);
    MessageReader reader(pipe.ends[0]);
    Message message;
    EXPECT_EQ(reader.read(message, late()), Exchange::garbled) << text;
  }
}

}  // namespace
}  // namespace penumbra::server
