#pragma once

namespace papilio::client {

/// A bar on standard error where that is a terminal; nothing elsewhere.
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
