#include "signals/system/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <utility>

namespace vibrissa::signals {
namespace {

constexpr std::size_t bar_width = 30;
constexpr double least_pause_s = 0.1;

std::string minutes_and_seconds(const double duration_s) {
  const auto seconds = static_cast<unsigned long long>(duration_s + 0.5);
  char text[48];
  if (seconds < 3600)
    std::snprintf(text, sizeof text, "%llu:%02llu", seconds / 60, seconds % 60);
  else
    std::snprintf(text, sizeof text, "%llu:%02llu:%02llu", seconds / 3600, seconds / 60 % 60,
                  seconds % 60);
  return text;
}

}  // namespace

Progress::Progress(std::string title, const std::size_t n_steps, const bool show)
    : title_(std::move(title)), n_steps_(n_steps), show_(show && ::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (show_) draw(true);
}

void Progress::advance(const std::size_t n) {
  done_ += std::min(n, n_steps_ - done_);
  if (show_ && since_drawn_.elapsed_s() >= least_pause_s) draw(false);
}

void Progress::draw(const bool last) {
  since_drawn_.restart();
  const double elapsed_s = since_start_.elapsed_s();
  const double part =
      n_steps_ == 0 ? 1. : static_cast<double>(done_) / static_cast<double>(n_steps_);
  const auto filled = static_cast<std::size_t>(part * static_cast<double>(bar_width));
  std::string line = "\r" + title_ + " [" + std::string(filled, '#') +
                     std::string(bar_width - filled, '.') + "] " +
                     std::to_string(static_cast<int>(100. * part)) + " %  ";
  if (last)
    line += minutes_and_seconds(elapsed_s) + " in total";
  else if (done_ > 0)
    line += minutes_and_seconds(elapsed_s * (1. - part) / part) + " left";
  const char* const clear_rest_of_line = "\033[K";
  line += clear_rest_of_line;
  if (last) line += '\n';
  std::cerr << line << std::flush;
}

}  // namespace vibrissa::signals
