// SPDX-License-Identifier: Apache-2.0
#include "explore/model/contents.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::explore {

std::optional<std::size_t> Content::next() const {
  for (std::size_t i = 0; i < size_; ++i)
    if (!message_[i].strays) return i;
  return std::nullopt;
}

void Content::push(WordId word) {
  TAKT_CHECK(size_ < most_capacity, "a full channel takes nothing");
  message_[size_++] = Message{word, false, false, false, false};
}

void Content::remove(std::size_t i) {
  TAKT_CHECK(i < size_, "only what is in flight can go");
  // What was a copy of this one is a copy of the next one only if this one was, too.
  if (i > 0 && message_[i - 1].twin) message_[i - 1].twin = message_[i].twin;
  std::copy(message_.begin() + static_cast<std::ptrdiff_t>(i) + 1, message_.begin() + size_,
            message_.begin() + static_cast<std::ptrdiff_t>(i));
  message_[--size_] = Message{};
}

Message Content::take(std::size_t i) {
  const Message taken = message_[i];
  bool twins = true;
  for (std::size_t older = i; older-- > 0 && !taken.overtaken;) {
    twins = twins && message_[older].twin;
    if (!twins) message_[older].overtaken = true;
  }
  remove(i);
  return taken;
}

void Content::copy(std::size_t i) {
  TAKT_CHECK(size_ < most_capacity && i < size_, "a copy needs room");
  std::copy_backward(message_.begin() + static_cast<std::ptrdiff_t>(i), message_.begin() + size_,
                     message_.begin() + size_ + 1);
  ++size_;
  message_[i].strays = true;
  message_[i].twin = true;
}

std::uint64_t Content::hash() const {
  std::uint64_t digest = size_;
  for (std::size_t i = 0; i < size_; ++i) {
    const Message& each = message_[i];
    digest = mixed(digest) ^ (each.word | std::uint64_t{each.strays} << 16 | std::uint64_t{each.overtaken} << 17 |
                              std::uint64_t{each.twin} << 18 | std::uint64_t{each.outdated} << 19);
  }
  return mixed(digest);
}

std::uint32_t Contents::intern(const Content& content) {
  const std::uint32_t id = contents_.intern(content);
  if (id < orbit_.size()) return id;
  const std::size_t count = renamings_->size();
  std::vector<std::uint32_t> images;
  for (std::size_t r = 0; r < count; ++r) {
    Content image = content;
    for (std::size_t i = 0; i < image.size(); ++i) image[i].word = members_->renamed_word(image[i].word, r);
    images.push_back(contents_.intern(image));
  }
  renamed_.resize(contents_.size() * count);
  orbit_.resize(contents_.size());
  const std::uint32_t least = *std::min_element(images.begin(), images.end());
  for (std::size_t r = 0; r < count; ++r) {
    orbit_[images[r]] = least;
    for (std::size_t s = 0; s < count; ++s) renamed_[images[r] * count + s] = images[renamings_->then(r, s)];
  }
  return id;
}

}  // namespace takt::explore
