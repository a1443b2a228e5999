#include "node/key_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <utility>

#include "node/socket.hpp"
#include "node/message_security.hpp"

namespace takt::node {
namespace {

constexpr std::size_t longest_file = std::size_t{1} << 20;
constexpr std::size_t least_secret = 32;

int digit_of(char c) { return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1; }

void wipe(std::string& text) { security::wipe(std::as_writable_bytes(std::span(text))); }

/// The octets; the digits are cleared. Nothing if some are none.
std::optional<security::Secret> from_hex(std::string& digits) {
  security::Secret octets(digits.size() / 2);
  bool is_sound = digits.size() % 2 == 0;
  for (std::size_t i = 0; is_sound && i < octets.size(); ++i) {
    const int high = digit_of(digits[2 * i]);
    const int low = digit_of(digits[2 * i + 1]);
    is_sound = high >= 0 && low >= 0;
    if (is_sound) octets.octets()[i] = static_cast<std::byte>(high << 4 | low);
  }
  wipe(digits);
  return is_sound ? std::optional(std::move(octets)) : std::nullopt;
}

/// What is in the way of trusting the file; "" if nothing is.
std::string distrust(int file) {
  struct stat status = {};
  if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return "no regular file";
  if (status.st_uid != ::geteuid() && status.st_uid != 0) return "a file of another user";
  if ((status.st_mode & 077) != 0) return "a file that others than its owner may read or write";
  return static_cast<std::size_t>(status.st_size) > longest_file ? "a file of more than 1 MiB" : "";
}

std::optional<std::string> read(const std::string& path, const json::Place& named_at, json::Diagnostics& diagnostics) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  const std::string problem = file.is_open() ? distrust(file.number()) : what_failed("a file that cannot be read");
  if (!problem.empty()) {
    diagnostics.error(named_at, "keys in " + json::quote(path), {problem, "a file of this user or of root with mode 0600 or 0400"});
    return std::nullopt;
  }
  std::string text(longest_file, '\0');
  std::size_t size = 0;
  for (ssize_t taken = 1; taken > 0 && size < text.size(); size += taken > 0 ? static_cast<std::size_t>(taken) : 0) taken = ::read(file.number(), text.data() + size, text.size() - size);
  text.resize(size);
  return text;
}

}  // namespace

const json::Object& describe(json::Type<KeyFile>) {
  using json::optional;
  using json::required;
  static constexpr json::Field fields[] = {
      required<&KeyFile::group>("group", "The SecurityGroup."),
      optional<&KeyFile::policy>("policy", "The same as that of the programs."),
      optional<&KeyFile::secret>("secret", "Hexadecimal digits, 64 at least, the same at all nodes: each key is derived from it. Or"),
      optional<&KeyFile::keys>("keys", "the keys, each 104 (aes128-ctr) or 136 (aes256-ctr) hexadecimal digits, one behind the other.", {.min_items = 1, .max_items = 4096}),
      optional<&KeyFile::first_token>("first_token", "SecurityTokenId of the first key.", {.min = 1}),
      optional<&KeyFile::first_at>("first_at", "When its time begins: seconds since 1970 on CLOCK_REALTIME, or on CLOCK_TAI if the nodes share that.", {.min = 0, .max = 4'000'000'000}),
  };
  static constexpr std::string_view members[] = {"secret", "keys"};
  static constexpr json::Group groups[] = {json::exactly_one_of(members)};
  static constexpr json::Object table = json::object<KeyFile>("keys", "Keys of a SecurityGroup.", fields, {.groups = groups});
  return table;
}

security::KeyRing LoadedKeys::ring(sim::Duration lifetime) const { return {policy, {first_token, first_ns, lifetime.ps() / 1000}, source->clone()}; }

std::optional<LoadedKeys> load_keys(const std::string& path, const json::Place& named_at, json::Diagnostics& diagnostics) {
  const std::size_t errors_before = diagnostics.errors();
  auto text = read(path, named_at, diagnostics);
  if (!text) return std::nullopt;
  KeyFile file;
  const auto document = json::parse(*text, path, diagnostics);
  wipe(*text);
  if (!document || !json::decode(*document, file, diagnostics)) return std::nullopt;
  const auto refuse = [&](const json::Place& place, const std::string& expected) { diagnostics.error(place, "not a key", {"something else, which is not shown", expected}); };
  LoadedKeys loaded{file.group, file.policy, file.first_token, file.first_at * 1'000'000'000, nullptr};
  if (file.secret) {
    auto secret = from_hex(*file.secret);
    if (!secret || secret->size() < least_secret) refuse(file.where.at("secret"), "64 hexadecimal digits or more, in pairs");
    else loaded.source = std::make_shared<security::DerivedKeys>(file.policy, file.group, std::move(*secret));
  }
  std::vector<security::Secret> keys;
  for (std::size_t i = 0; i < file.keys.size(); ++i) {
    auto key = from_hex(file.keys[i]);
    const std::size_t octets = security::key_octets(file.policy);
    if (!key || key->size() != octets) refuse(file.where.at("keys", i), std::to_string(2 * octets) + " hexadecimal digits");
    else keys.push_back(std::move(*key));
  }
  if (!file.secret) loaded.source = std::make_shared<security::ListedKeys>(file.first_token, std::move(keys));
  return diagnostics.errors() == errors_before ? std::optional(std::move(loaded)) : std::nullopt;
}

}  // namespace takt::node
