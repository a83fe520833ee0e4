#pragma once

namespace papilio::client {

/// Progress bar on standard error, if that is a terminal.
class ShareProgress {
 public:
  ShareProgress();
  ~ShareProgress();
  ShareProgress(const ShareProgress&) = delete;
  ShareProgress& operator=(const ShareProgress&) = delete;

  /// Shows the share done, 0 to 1.
  void show(double share);

 private:
  bool on_terminal_;
  int percent_ = -1;
};

}  // namespace papilio::client
