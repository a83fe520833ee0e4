#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <new>
#include <type_traits>
#include <utility>

namespace papilio {

/// Returns a block of at least `bytes` bytes, aligned to 64. Thread-safe. Throws std::bad_alloc.
[[nodiscard]] void* take_block(size_t bytes);
/// Takes a block back; `bytes` is the argument of its take_block(). Keeps it for later calls of take_block().
void give_block(void* block, size_t bytes) noexcept;

/// Upper bound of the bytes in spare blocks: blocks kept for later calls of take_block().
inline constexpr size_t spare_limit = size_t{2} << 30;
/// Returns the bytes in spare blocks now.
[[nodiscard]] size_t spare_bytes() noexcept;
/// Returns spare blocks to the system until at most `most_kept` bytes are kept.
void release_spare_blocks(size_t most_kept = 0) noexcept;

/// Vector of trivially copyable elements, for the long arrays of meshes. Its memory comes from take_block(): the system
/// provides fresh pages slowly, so blocks are reused. Invalidates iterators and references as std::vector does. Not
/// thread-safe, but distinct objects are independent.
template <class T>
class Buffer {
 public:
  using value_type = T;
  using size_type = size_t;
  using difference_type = ptrdiff_t;
  using reference = T&;
  using const_reference = const T&;
  using pointer = T*;
  using const_pointer = const T*;
  using iterator = T*;
  using const_iterator = const T*;

  /// Bytes behind the last element that may be read; their values are unspecified.
  static constexpr size_t readable_behind_end = 16;

  Buffer() = default;
  /// Holds `count` zeros.
  explicit Buffer(size_t count) { resize(count); }
  Buffer(size_t count, const T& value) { assign(count, value); }
  Buffer(std::initializer_list<T> values) { assign(values.begin(), values.end()); }
  template <std::forward_iterator Iterator>
  Buffer(Iterator first, Iterator last) {
    assign(first, last);
  }
  Buffer(const Buffer& other) { assign(other.begin(), other.end()); }
  Buffer(Buffer&& other) noexcept
      : begin_(std::exchange(other.begin_, nullptr)),
        end_(std::exchange(other.end_, nullptr)),
        limit_(std::exchange(other.limit_, nullptr)) {}
  Buffer& operator=(const Buffer& other) {
    if (this != &other) assign(other.begin(), other.end());
    return *this;
  }
  Buffer& operator=(Buffer&& other) noexcept {
    Buffer taken(std::move(other));
    swap(taken);
    return *this;
  }
  /// Assigns the values. `= {}` returns the memory, which clear() keeps.
  Buffer& operator=(std::initializer_list<T> values) {
    if (values.size() == 0) Buffer().swap(*this);
    assign(values.begin(), values.end());
    return *this;
  }
  ~Buffer() { give_back(); }

  /// Returns `count` elements, each of which must be written before it is read.
  [[nodiscard]] static Buffer for_overwrite(size_t count) {
    Buffer made;
    made.resize_for_overwrite(count);
    return made;
  }

  [[nodiscard]] size_t size() const { return static_cast<size_t>(end_ - begin_); }
  [[nodiscard]] size_t capacity() const { return static_cast<size_t>(limit_ - begin_); }
  [[nodiscard]] bool empty() const { return begin_ == end_; }

  [[nodiscard]] T* data() { return begin_; }
  [[nodiscard]] const T* data() const { return begin_; }
  [[nodiscard]] T* begin() { return begin_; }
  [[nodiscard]] const T* begin() const { return begin_; }
  [[nodiscard]] T* end() { return end_; }
  [[nodiscard]] const T* end() const { return end_; }
  [[nodiscard]] T& operator[](size_t i) { return begin_[i]; }
  [[nodiscard]] const T& operator[](size_t i) const { return begin_[i]; }
  [[nodiscard]] T& front() { return *begin_; }
  [[nodiscard]] const T& front() const { return *begin_; }
  [[nodiscard]] T& back() { return end_[-1]; }
  [[nodiscard]] const T& back() const { return end_[-1]; }

  void push_back(const T& value) {
    const T copy = value;  // `value` may be an element of this
    if (end_ == limit_) move_to(larger_by(1));
    *end_++ = copy;
  }
  void pop_back() { --end_; }
  /// Inserts elements before `at`; they must not be elements of this. Returns the position of the first.
  template <std::forward_iterator Iterator>
  T* insert(const T* at, Iterator first, Iterator last) {
    const auto before = static_cast<size_t>(at - begin_);
    const size_t behind = size() - before;
    resize_for_overwrite(size() + static_cast<size_t>(std::distance(first, last)));
    std::copy_backward(begin_ + before, begin_ + before + behind, end_);
    std::copy(first, last, begin_ + before);
    return begin_ + before;
  }
  T* insert(const T* at, std::initializer_list<T> values) { return insert(at, values.begin(), values.end()); }

  void reserve(size_t count) {
    if (count > capacity()) move_to(count);
  }
  /// Changes the size; new elements are zero.
  void resize(size_t count) { resize(count, T{}); }
  void resize(size_t count, const T& value) {
    const T copy = value;  // `value` may be an element of this
    const size_t old = size();
    resize_for_overwrite(count);
    if (count > old) std::fill(begin_ + old, end_, copy);
  }
  /// Changes the size; new elements must be written before they are read.
  void resize_for_overwrite(size_t count) {
    if (count > capacity()) move_to(larger_by(count - size()));
    end_ = begin_ + count;
  }
  void assign(size_t count, const T& value) {
    const T copy = value;  // `value` may be an element of this
    set_size(count);
    std::fill(begin_, end_, copy);
  }
  /// Assigns a range, which must not be part of this.
  template <std::forward_iterator Iterator>
  void assign(Iterator first, Iterator last) {
    set_size(static_cast<size_t>(std::distance(first, last)));
    std::copy(first, last, begin_);
  }
  void assign(std::initializer_list<T> values) { assign(values.begin(), values.end()); }
  /// Removes all elements; keeps the capacity.
  void clear() { end_ = begin_; }

  void swap(Buffer& other) noexcept {
    std::swap(begin_, other.begin_);
    std::swap(end_, other.end_);
    std::swap(limit_, other.limit_);
  }
  friend void swap(Buffer& a, Buffer& b) noexcept { a.swap(b); }
  /// Removes the elements for which `is_unwanted` is true; returns their number.
  template <class IsUnwanted>
  friend size_t erase_if(Buffer& buffer, const IsUnwanted& is_unwanted) {
    const size_t old = buffer.size();
    buffer.end_ = std::remove_if(buffer.begin_, buffer.end_, is_unwanted);
    return old - buffer.size();
  }
  friend bool operator==(const Buffer& a, const Buffer& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  static size_t bytes_of(size_t count) { return count * sizeof(T) + readable_behind_end; }
  static T* take(size_t count) {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T> && alignof(T) <= 64);
    if (count > (SIZE_MAX / 2 - readable_behind_end) / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(take_block(bytes_of(count)));
  }
  void give_back() noexcept {
    if (begin_ != nullptr) give_block(begin_, bytes_of(capacity()));
  }

  /// Returns a capacity for `more` further elements; at least doubles the size, so that repeated growth is linear.
  [[nodiscard]] size_t larger_by(size_t more) const { return size() + std::max(size(), more); }
  void move_to(size_t new_capacity) {
    T* const block = take(new_capacity);
    T* const end = std::copy(begin_, end_, block);
    give_back();
    begin_ = block;
    end_ = end;
    limit_ = block + new_capacity;
  }
  /// Changes the size; all elements must be written afterwards.
  void set_size(size_t count) {
    if (count > capacity()) {
      T* const block = take(count);
      give_back();
      begin_ = block;
      limit_ = block + count;
    }
    end_ = begin_ + count;
  }

  T* begin_ = nullptr;
  T* end_ = nullptr;
  T* limit_ = nullptr;
};

}  // namespace papilio
