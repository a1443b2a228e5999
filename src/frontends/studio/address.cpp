// SPDX-License-Identifier: Apache-2.0
#include "studio/address.hpp"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "sim/check.hpp"
#include "studio/document.hpp"

namespace takt::studio {
namespace {

constexpr std::size_t token_digits = 32;

std::string folder_of_user() {
  if (const char* const folder = std::getenv("XDG_RUNTIME_DIR"); folder != nullptr && *folder == '/') return folder;
  if (::geteuid() == 0) return "/run";
  return "/tmp/takt-" + std::to_string(::geteuid());
}

/// In /tmp anybody may have made it.
bool is_private_folder(const std::string& path) {
  ::mkdir(path.c_str(), 0700);
  struct stat found {};
  return ::lstat(path.c_str(), &found) == 0 && S_ISDIR(found.st_mode) && found.st_uid == ::geteuid() &&
         (found.st_mode & 0022) == 0;
}

}  // namespace

std::string new_token() {
  std::array<unsigned char, token_digits / 2> octets{};
  TAKT_CHECK(getrandom(octets.data(), octets.size(), 0) == static_cast<ssize_t>(octets.size()),
             "the operating system has random numbers");
  std::string token;
  constexpr const char* digits = "0123456789abcdef";
  for (const unsigned char octet : octets) {
    token += digits[octet >> 4];
    token += digits[octet & 15];
  }
  return token;
}

AddressMemory::AddressMemory(const std::string& scenario) : folder_(folder_of_user()) {
  std::error_code error;
  const std::filesystem::path whole =
      std::filesystem::weakly_canonical(std::filesystem::absolute(scenario, error), error);
  path_ = folder_ + "/takt-studio-" + Document::digest_of(error ? scenario : whole.string());
}

std::optional<Address> AddressMemory::last() const {
  if (!is_private_folder(folder_)) return std::nullopt;
  const int file = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) return std::nullopt;
  struct stat found {};
  std::array<char, 64> text{};
  const bool is_own = ::fstat(file, &found) == 0 && S_ISREG(found.st_mode) && found.st_uid == ::geteuid() &&
                      (found.st_mode & 0077) == 0;
  const ssize_t octets = is_own ? ::read(file, text.data(), text.size()) : 0;
  ::close(file);
  Address address;
  const std::string_view content(text.data(), octets > 0 ? static_cast<std::size_t>(octets) : 0);
  const auto [end, error] = std::from_chars(content.data(), content.data() + content.size(), address.port);
  if (error != std::errc() || content.substr(static_cast<std::size_t>(end - content.data())).size() != token_digits + 1)
    return std::nullopt;
  address.token = content.substr(content.size() - token_digits);
  if (address.port == 0 || address.token.find_first_not_of("0123456789abcdef") != std::string::npos)
    return std::nullopt;
  return address;
}

bool AddressMemory::write(const std::string& path, const std::string& content) const {
  if (!is_private_folder(folder_)) return false;
  const std::string temporary = path + "." + std::to_string(::getpid());
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (file < 0) return false;
  const bool is_whole = ::write(file, content.data(), content.size()) == static_cast<ssize_t>(content.size());
  ::close(file);
  if (is_whole && std::rename(temporary.c_str(), path.c_str()) == 0) return true;
  ::unlink(temporary.c_str());
  return false;
}

void AddressMemory::keep(const Address& address) const {
  write(path_, std::to_string(address.port) + " " + address.token);
}

std::optional<std::string> AddressMemory::door(const std::string& address) const {
  std::string path = path_ + ".html";
  const std::string page =
      "<!doctype html><meta charset=\"utf-8\"><title>takt studio</title><meta name=\"referrer\" "
      "content=\"no-referrer\"><meta http-equiv=\"refresh\" content=\"0; url=" +
      address + "\"><a href=\"" + address + "\">takt studio</a>\n";
  return write(path, page) ? std::optional(std::move(path)) : std::nullopt;
}

void AddressMemory::forget(const Address& own) const {
  if (const auto kept = last(); !kept || kept->token != own.token) return;
  ::unlink(path_.c_str());
  ::unlink((path_ + ".html").c_str());
}

}  // namespace takt::studio
