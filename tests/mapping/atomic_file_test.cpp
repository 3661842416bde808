#include <gtest/gtest.h>

#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/error.h>

#include "tests/support/table_files.h"

namespace gonio {
namespace {

using namespace test;

long entries(const TemporaryFolder& folder) {
  return std::distance(std::filesystem::directory_iterator(folder.path()), {});
}

TEST(AtomicFile, ReplacesAsAWhole) {
  const TemporaryFolder folder;
  for (const char* text : {"first", "second"}) {
    write_stream_atomically(folder / "x", [&](std::ostream& stream) { stream << text; });
    EXPECT_EQ(file_bytes(folder / "x"), text);
    EXPECT_EQ(entries(folder), 1);
  }
}

TEST(AtomicFile, KeepsTheOldFileWhenWritingThrows) {
  const TemporaryFolder folder;
  write_file(folder / "x", "old");
  const auto fail = [](std::ostream& stream) {
    stream << "half";
    throw std::runtime_error("midway");
  };
  EXPECT_THROW(write_stream_atomically(folder / "x", fail), std::runtime_error);
  EXPECT_EQ(file_bytes(folder / "x"), "old");
  EXPECT_EQ(entries(folder), 1);
}

TEST(AtomicFile, FullDiskIsAnError) {
  const TemporaryFolder folder;
  const auto full = [](std::ostream& stream) { stream.setstate(std::ios::badbit); };
  EXPECT_THROW(write_stream_atomically(folder / "x", full), Error);
  EXPECT_EQ(entries(folder), 0);
}

TEST(AtomicFile, FollowsLinksAndRefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  write_file(folder / "real", "old");
  std::filesystem::create_symlink(folder / "real", folder / "link");
  write_stream_atomically(folder / "link", [](std::ostream& stream) { stream << "new"; });
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(file_bytes(folder / "real"), "new");
  const auto nothing = [](std::ostream&) {};
  EXPECT_THROW(write_stream_atomically(folder.path(), nothing), Error);
  EXPECT_THROW(write_stream_atomically(folder.path() / "none" / "x", nothing), Error);
}

/// What the error says, or "no error".
std::string message(const std::filesystem::path& path) {
  try {
    write_stream_atomically(path, [](std::ostream& stream) { stream << "x"; });
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// A file system takes names of up to 255 bytes, and so does the writer.
TEST(AtomicFile, AnyNameThatAFileMayHave) {
  const TemporaryFolder folder;
  for (const std::size_t length : {1u, 239u, 240u, 244u, 255u}) {
    const std::string name(length, 'n');
    EXPECT_EQ(message(folder / name), "no error") << length;
    EXPECT_EQ(file_bytes(folder / name), "x") << length;
  }
  const std::string too_long(256, 'n');
  EXPECT_EQ(message(folder / too_long), (folder / too_long).string() + ": cannot be written: File name too long");
  EXPECT_EQ(entries(folder), 5);
}

TEST(AtomicFile, SaysWhatIsInTheWay) {
  const TemporaryFolder folder;
  EXPECT_NE(message(folder.path()).find("found a folder, expected a file or nothing"), std::string::npos);
  EXPECT_NE(message("/dev/null").find("found something that is not a file"), std::string::npos);
  EXPECT_NE(message("/proc/x").find("/proc/x: folder: found one that takes no files"), std::string::npos);
}

}  // namespace
}  // namespace gonio
