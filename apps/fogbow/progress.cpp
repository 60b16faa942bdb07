// SPDX-License-Identifier: GPL-3.0-or-later
#include "apps/fogbow/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "apps/fogbow/console.h"

namespace fogbow::cli {

namespace {

constexpr std::chrono::duration<double> kRedraw{0.1};
constexpr std::chrono::duration<double> kShortestLineGap{2}, kLongestLineGap{60};

int terminal_columns() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

/// Columns that UTF-8 text without wide characters takes.
int display_width(std::string_view text) {
  return static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

/// The first `columns` columns of `text`, so that the bar never wraps.
std::string cut(const std::string& text, int columns) {
  std::size_t end = 0;
  while (end < text.size() && display_width(std::string_view(text).substr(0, end + 1)) <= columns)
    ++end;
  return text.substr(0, end);
}

}  // namespace

ProgressDisplay::ProgressDisplay(Style style, std::string unit, MessageLog& log)
    : style_(style), unit_(std::move(unit)), log_(log) {
  log_.set_printer([this](LogLevel level, std::string_view message) { print(level, message); });
}

ProgressDisplay::~ProgressDisplay() {
  erase_bar();
  log_.set_printer(print_message);
}

ProgressDisplay::Style ProgressDisplay::default_style() {
  const char* terminal = std::getenv("TERM");
  const bool can_erase =
      ::isatty(STDERR_FILENO) && !(terminal && std::strcmp(terminal, "dumb") == 0);
  return can_erase ? Style::Bar : Style::Lines;
}

std::string ProgressDisplay::status(const RenderProgress& progress) const {
  std::string text =
      format("%3.0f%%  %s", 100 * progress.fraction, duration(progress.seconds).c_str());
  if (progress.fraction > 0 && progress.fraction < 1)
    text += "  ETA " + duration(progress.seconds * (1 / progress.fraction - 1));
  if (progress.b > 0) text += "  b " + with_error(progress.b, progress.b_stderr);
  if (progress.samples_per_second > 0)
    text += "  " + with_si_prefix(progress.samples_per_second) + " " + unit_ + "/s";
  return text;
}

std::string ProgressDisplay::bar_line(const RenderProgress& progress) const {
  const std::string text = status(progress);
  const int columns = terminal_columns() - 1;
  const int room =
      columns - display_width(text) - display_width(progress.stage) - 4;  // brackets, two spaces
  if (room < 5) return cut(progress.stage + " " + text, columns);
  const int length = std::min(room, 40);
  const int filled = std::clamp(static_cast<int>(progress.fraction * length), 0, length);
  std::string bar(static_cast<std::size_t>(length), ' ');
  std::fill_n(bar.begin(), filled, '=');
  if (filled < length) bar[static_cast<std::size_t>(filled)] = '>';
  return progress.stage + " [" + bar + "] " + text;
}

void ProgressDisplay::erase_bar() {
  if (shown_.empty()) return;
  std::fputs("\r\x1b[K", stderr);
  shown_.clear();
}

void ProgressDisplay::update(const RenderProgress& progress) {
  if (style_ == Style::None) return;
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  if (now < next_ && progress.stage == stage_) return;
  stage_ = progress.stage;
  if (style_ == Style::Bar) {
    shown_ = bar_line(progress);
    std::fputs(("\r\x1b[K" + shown_).c_str(), stderr);
    next_ = now + std::chrono::duration_cast<Clock::duration>(kRedraw);
    return;
  }
  std::fputs((stage_ + " " + status(progress) + "\n").c_str(), stderr);
  // Half as long again as so far: a short render gets a few lines, a night's render not thousands.
  const std::chrono::duration<double> gap = 0.5 * (now - start_);
  next_ = now + std::chrono::duration_cast<Clock::duration>(
                    std::clamp(gap, kShortestLineGap, kLongestLineGap));
}

void ProgressDisplay::print(LogLevel level, std::string_view message) {
  const std::lock_guard lock(mutex_);
  const std::string bar = shown_;
  erase_bar();
  print_message(level, message);
  shown_ = bar;
  if (!shown_.empty()) std::fputs(shown_.c_str(), stderr);
}

}  // namespace fogbow::cli
