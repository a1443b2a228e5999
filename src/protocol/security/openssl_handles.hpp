// SPDX-License-Identifier: Apache-2.0
// For the .cpp files of this folder: OpenSSL's objects as values that are dropped by themselves.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "security/secret.hpp"

struct evp_pkey_ctx_st;
struct evp_md_ctx_st;
struct bio_st;

namespace takt::security::detail {

struct DropHandle {
  void operator()(evp_pkey_ctx_st* context) const;
  void operator()(evp_md_ctx_st* context) const;
  void operator()(bio_st* bio) const;
};
using KeyContext = std::unique_ptr<evp_pkey_ctx_st, DropHandle>;
using DigestContext = std::unique_ptr<evp_md_ctx_st, DropHandle>;
using Bio = std::unique_ptr<bio_st, DropHandle>;

/// What OpenSSL keeps of a failure is of no use to anybody, and must not be taken for a later one.
struct ForgetErrors {
  ForgetErrors() = default;
  ForgetErrors(const ForgetErrors&) = delete;
  ForgetErrors& operator=(const ForgetErrors&) = delete;
  ~ForgetErrors();
};

inline const unsigned char* characters(Octets octets) { return reinterpret_cast<const unsigned char*>(octets.data()); }
inline unsigned char* writable(std::span<std::byte> octets) { return reinterpret_cast<unsigned char*>(octets.data()); }

/// Reads the text, which outlives it. Null if there is no memory.
Bio bio_of(std::string_view text);
/// What was written into it.
std::string text_in(bio_st* bio);

}  // namespace takt::security::detail
