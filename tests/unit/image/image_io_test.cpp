// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image/image_io.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "core/util/error.h"

namespace fogbow {
namespace {

namespace fs = std::filesystem;

class ImageIo : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("fogbow_image_io_" + std::to_string(::getpid()) + "_" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const char* name) const { return (folder_ / name).string(); }
  int files() const { return static_cast<int>(std::distance(fs::directory_iterator(folder_), {})); }

  fs::path folder_;
};

void expect_io_error(const std::function<void()>& action, const std::string& part) {
  try {
    action();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InputOutput);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    EXPECT_GT(std::string(error.what()).size(), part.size() + 4) << "no reason: " << error.what();
  }
}

Image layered() {
  Image image(5, 3, {"R", "G", "B", "Error.R", "Error.G", "Error.B"});
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] =
        std::ldexp(1.0f + 0.001f * static_cast<float>(i), static_cast<int>(i % 60) - 30);
  image.x = 7;
  image.y = 11;
  image.full_width = 40;
  image.full_height = 30;
  return image;
}

TEST_F(ImageIo, ExrKeepsEveryBitAndWindow) {
  Image image = layered();
  image.pixels[4] = std::numeric_limits<float>::infinity();
  image.pixels[5] = std::numeric_limits<float>::denorm_min();
  image.pixels[6] = -0.0f;
  write_exr(path("a.exr"), image);
  EXPECT_EQ(files(), 1);
  const Image back = read_image(path("a.exr"));
  ASSERT_EQ(back.width, 5);
  ASSERT_EQ(back.height, 3);
  EXPECT_EQ(back.x, 7);
  EXPECT_EQ(back.y, 11);
  EXPECT_EQ(back.full_width, 40);
  EXPECT_EQ(back.full_height, 30);
  ASSERT_EQ(back.channels.size(), 6u);
  for (int c = 0; c < 6; ++c) {
    const int d = back.channel(image.channels[c]);
    ASSERT_GE(d, 0) << image.channels[c];
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 5; ++x) {
        EXPECT_EQ(back.at(x, y, d), image.at(x, y, c));
        EXPECT_EQ(std::signbit(back.at(x, y, d)), std::signbit(image.at(x, y, c)));
      }
  }
}

TEST_F(ImageIo, ExrKeepsMetadata) {
  Image image = layered();
  std::vector<float> matrix(16);
  for (int i = 0; i < 16; ++i) matrix[i] = 0.5f * static_cast<float>(i) - 3;
  image.metadata = {{"worldToCamera", matrix},
                    {"fogbow.b", 0.123f},
                    {"fogbow.chains", 4096},
                    {"fogbow.seed", std::string("18446744073709551615")},
                    {"fogbow.title", std::string("ring caustic, α = 0.1")},
                    {"renderTimeSeconds", 12.5f}};
  write_exr(path("m.exr"), image);
  const Image back = read_image(path("m.exr"));
  for (const auto& [name, value] : image.metadata) {
    ASSERT_TRUE(back.metadata.contains(name)) << name;
    EXPECT_EQ(back.metadata.at(name), value) << name;
  }
  // What was read can be written again.
  write_exr(path("n.exr"), back);
  EXPECT_EQ(read_image(path("n.exr")).metadata.at("worldToCamera"),
            image.metadata.at("worldToCamera"));
}

TEST_F(ImageIo, ABrokenMatrixIsRefused) {
  Image image = layered();
  image.metadata["worldToCamera"] = std::vector<float>(9);
  expect_io_error([&] { write_exr(path("a.exr"), image); }, "worldToCamera");
  EXPECT_EQ(files(), 0);
}

TEST_F(ImageIo, PngIsSrgbWithExposureAndClipping) {
  Image image(6, 1, {"Error.R", "B", "G", "R"});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float red[] = {0, 0.25f, 0.001f, 8, -3, nan};
  for (int x = 0; x < 6; ++x) {
    image.at(x, 0, image.channel("R")) = red[x];
    image.at(x, 0, image.channel("G")) = 0.0625f;
  }
  write_png(path("a.png"), image, 1);
  EXPECT_EQ(files(), 1);
  const Image back = read_image(path("a.png"));
  ASSERT_EQ(back.channels.size(), 3u);
  const auto value = [&](int x, int c) { return std::lround(255 * back.at(x, 0, c)); };
  // Doubled by the exposure: 0.5 is 188; 0.002 lies on the linear part, 12.92 · 0.002 · 255 = 6.6.
  EXPECT_EQ(value(0, 0), 0);
  EXPECT_EQ(value(1, 0), 188);
  EXPECT_EQ(value(2, 0), 7);
  EXPECT_EQ(value(3, 0), 255);
  EXPECT_EQ(value(4, 0), 0);
  EXPECT_EQ(value(0, 1), std::lround((1.055 * std::pow(0.125, 1 / 2.4) - 0.055) * 255));
  EXPECT_EQ(value(0, 2), 0);
  EXPECT_EQ(value(5, 0), 255);
  EXPECT_EQ(value(5, 1), 0);
  EXPECT_EQ(value(5, 2), 255);
}

TEST_F(ImageIo, AFailedWriteLeavesTheOldFileAndNothingElse) {
  const Image image = layered();
  write_exr(path("a.exr"), image);
  Image broken = image;
  broken.pixels.pop_back();
  expect_io_error([&] { write_exr(path("a.exr"), broken); }, "a.exr");
  expect_io_error([&] { write_png(path("b.png"), Image(2, 2, {"Y"})); }, "b.png");
  expect_io_error([&] { write_exr(path("none/a.exr"), image); }, "none/a.exr");
  fs::create_directory(path("folder.exr"));
  std::ofstream(path("folder.exr") + "/x") << "x";
  expect_io_error([&] { write_exr(path("folder.exr"), image); }, "folder.exr");
  EXPECT_EQ(files(), 2);
  EXPECT_EQ(read_image(path("a.exr")).pixels.size(), image.pixels.size());
}

TEST_F(ImageIo, ReplacesAFileWhole) {
  write_exr(path("a.exr"), layered());
  write_exr(path("a.exr"), Image(3, 2, {"R", "G", "B"}));
  EXPECT_EQ(read_image(path("a.exr")).width, 3);
  EXPECT_EQ(files(), 1);
}

TEST_F(ImageIo, BadFilesAreErrors) {
  expect_io_error([&] { read_image(path("absent.exr")); }, "absent.exr");
  std::ofstream(path("garbage.exr")) << "this is no picture";
  expect_io_error([&] { read_image(path("garbage.exr")); }, "garbage.exr");
  std::ofstream(path("empty.png"));
  expect_io_error([&] { read_image(path("empty.png")); }, "empty.png");
  write_exr(path("whole.exr"), layered());
  const auto size = fs::file_size(path("whole.exr"));
  for (std::uintmax_t n = 0; n < size; n += 13) {
    fs::copy_file(path("whole.exr"), path("part.exr"), fs::copy_options::overwrite_existing);
    fs::resize_file(path("part.exr"), n);
    expect_io_error([&] { read_image(path("part.exr")); }, "part.exr");
  }
  expect_io_error([&] { write_exr(path("a.jpg"), layered()); }, "a.jpg");
}

}  // namespace
}  // namespace fogbow
