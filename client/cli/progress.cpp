#include "client/cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <string>

namespace papilio::client {

ShareProgress::ShareProgress() : on_terminal_(isatty(STDERR_FILENO) == 1) {}

ShareProgress::~ShareProgress() {
  if (percent_ >= 0) std::cerr << "\r\033[K" << std::flush;
}

void ShareProgress::show(double share) {
  const int percent = static_cast<int>(100 * std::clamp(share, 0.0, 1.0));
  if (!on_terminal_ || percent == percent_) return;
  percent_ = percent;
  constexpr size_t width = 30;
  const size_t filled = width * static_cast<size_t>(percent) / 100;
  std::cerr << "\r[" << std::string(filled, '#') << std::string(width - filled, '.') << "] " << percent << " %"
            << std::flush;
}

}  // namespace papilio::client
