#include "proto/detail/turned_detail.h"

#include <array>
#include <atomic>
#include <mutex>
#include <utility>

namespace papilio::proto::detail {
namespace {

class TurnedDetail final : public Detail {
 public:
  explicit TurnedDetail(std::shared_ptr<const Detail> detail) : detail_(std::move(detail)) {}

  [[nodiscard]] bool fits(const Mesh& mesh) const override { return detail_->fits(mesh); }
  [[nodiscard]] const Topology& base() const override { return detail_->base(); }
  [[nodiscard]] int level_count() const override { return detail_->level_count(); }
  [[nodiscard]] std::span<const Vec3f> new_vertices(int level, const std::function<bool()>& cancelled) const override {
    return detail_->new_vertices(level, cancelled);
  }
  [[nodiscard]] std::span<const Texcoord> new_texcoords(int level,
                                                        const std::function<bool()>& cancelled) const override {
    const std::span<const Texcoord> given = detail_->new_texcoords(level, cancelled);
    const std::lock_guard lock(access_);
    Buffer<Texcoord>& turned = turned_.at(static_cast<size_t>(level));
    if (turned.empty() && !given.empty()) {
      turned.reserve(given.size());
      for (const auto& [u, v] : given) turned.push_back({u, 1 - v});
      bytes_ += given.size() * sizeof(Texcoord);
    }
    return {turned.data(), turned.size()};
  }
  [[nodiscard]] std::span<const Colour> new_colours(int level, const std::function<bool()>& cancelled) const override {
    return detail_->new_colours(level, cancelled);
  }
  [[nodiscard]] double largest_move(int level, const std::function<bool()>& cancelled) const override {
    return detail_->largest_move(level, cancelled);
  }
  [[nodiscard]] uint64_t bytes() const override { return detail_->bytes() + bytes_; }

 private:
  std::shared_ptr<const Detail> detail_;
  mutable std::mutex access_;  ///< guards `turned_`, whose buffers stay valid once made
  mutable std::array<Buffer<Texcoord>, most_detail_levels> turned_;
  mutable std::atomic<uint64_t> bytes_ = 0;
};

}  // namespace

std::shared_ptr<const Detail> turned_over(std::shared_ptr<const Detail> detail) {
  return std::make_shared<const TurnedDetail>(std::move(detail));
}

}  // namespace papilio::proto::detail
