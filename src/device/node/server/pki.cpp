// SPDX-License-Identifier: Apache-2.0
#include "node/server/pki.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <tuple>

#include "node/program_reporter.hpp"

namespace takt::node {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t most_file_octets = 1 << 20;
constexpr std::size_t most_files = 1000;
constexpr unsigned key_bits = 2048;
constexpr std::int64_t ten_years_s = 10LL * 365 * 86'400;

constexpr const char* folders[] = {"own/certs",     "own/private", "trusted/certs", "trusted/crl",
                                   "issuers/certs", "issuers/crl", "rejected"};

std::string read_file(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error) || fs::file_size(path, error) > most_file_octets) return {};
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

security::Octets octets_of(const std::string& text) { return std::as_bytes(std::span(text.data(), text.size())); }

enum class Durability : std::uint8_t { now, whenever };

/// Whole or not at all, and from the beginning with these permissions.
bool write_file(const fs::path& path, security::Octets octets, mode_t mode, Durability durability = Durability::now) {
  const std::string temporary = path.string() + ".new";
  ::unlink(temporary.c_str());
  const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, mode);
  if (fd < 0) return false;
  std::size_t written = 0;
  while (written < octets.size()) {
    const ssize_t more = ::write(fd, octets.data() + written, octets.size() - written);
    if (more <= 0) break;
    written += static_cast<std::size_t>(more);
  }
  const bool is_written = written == octets.size() && (durability == Durability::whenever || ::fsync(fd) == 0);
  ::close(fd);
  if (is_written && ::rename(temporary.c_str(), path.c_str()) == 0) return true;
  ::unlink(temporary.c_str());
  return false;
}

/// Who may write there decides who is trusted.
bool may_others_write(const fs::path& path) {
  struct stat status = {};
  return ::stat(path.c_str(), &status) != 0 || (status.st_mode & 022) != 0 ||
         (status.st_uid != ::geteuid() && status.st_uid != 0);
}

/// Each file of a folder, in the order of their names, as DER or as PEM.
template <class T>
void read_all(const fs::path& folder, std::vector<T>& into, std::vector<std::string>& passed_over) {
  std::error_code error;
  if (may_others_write(folder))
    return passed_over.push_back(folder.string() + " belongs to another user, or others may write there");
  std::vector<fs::path> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  for (const fs::path& path : paths) {
    if (into.size() >= most_files) return;
    if (may_others_write(path)) {
      passed_over.push_back(path.string() + " belongs to another user, or others may write it");
      continue;
    }
    const std::string text = read_file(path);
    auto found = T::from_der(octets_of(text));
    if (!found) found = T::from_pem(text);
    if (found)
      into.push_back(std::move(*found));
    else
      passed_over.push_back(path.string() + " is neither a certificate nor a revocation list, as it should be here");
  }
}

std::string hexadecimal(security::Octets octets) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text;
  for (const std::byte each : octets)
    text += {digits[static_cast<unsigned>(each) >> 4], digits[static_cast<unsigned>(each) & 15]};
  return text;
}

bool may_others_read(const fs::path& path) {
  struct stat status = {};
  return ::stat(path.c_str(), &status) != 0 || (status.st_mode & 077) != 0;
}

}  // namespace

std::optional<opcua::Identity> Pki::identity(const security::OwnCertificate& of, security::RandomOctets& random,
                                             std::string& problem) const {
  std::error_code error;
  for (const char* const each : folders)
    if (fs::create_directories(fs::path(folder_) / each, error))
      ::chmod((fs::path(folder_) / each).c_str(), 0755);  // whatever the umask: nobody else writes there
  const fs::path key_path = fs::path(folder_) / "own/private/key.pem";
  const fs::path certificate_path = fs::path(folder_) / "own/certs/certificate.der";
  if (error) {
    problem = folder_ + ": " + error.message();
    return std::nullopt;
  }
  ::chmod((fs::path(folder_) / "own/private").c_str(), 0700);
  const bool has_key = fs::exists(key_path, error);
  if (has_key && may_others_read(key_path)) {
    problem = key_path.string() + " may be read by others; chmod 600, and make a new one if they have";
    return std::nullopt;
  }
  const std::string key_text = has_key ? read_file(key_path) : std::string();
  std::optional<security::PrivateKey> key = has_key ? security::PrivateKey::from_pem(key_text) : std::nullopt;
  if (has_key && !key) {
    problem = key_path.string() + " is no RSA key without a password (PEM)";
    return std::nullopt;
  }
  try {
    if (!key) {
      key = security::PrivateKey::generate(key_bits);
      const std::string text = key->to_pem();
      if (!write_file(key_path, octets_of(text), 0600)) {
        problem = key_path.string() + ": " + std::strerror(errno);
        return std::nullopt;
      }
    }
    const std::string kept = read_file(certificate_path);
    auto certificate = security::Certificate::from_der(octets_of(kept));
    // A certificate of another key or another name is of no use to anybody.
    const std::string proof = "this key";
    const bool fits = certificate && certificate->application_uri() == of.application_uri &&
                      certificate->valid_until() > of.valid_from &&
                      certificate->key().verify(security::SignatureScheme::pkcs1_sha256, octets_of(proof),
                                                key->sign(security::SignatureScheme::pkcs1_sha256, octets_of(proof)));
    if (!fits) {
      security::OwnCertificate wanted = of;
      wanted.valid_until = of.valid_from + ten_years_s;
      random.fill(std::as_writable_bytes(std::span(&wanted.serial, 1)));
      wanted.serial = (wanted.serial >> 1) | 1;
      certificate = security::self_signed(*key, wanted);
      if (!write_file(certificate_path, certificate->der(), 0644)) {
        problem = certificate_path.string() + ": " + std::strerror(errno);
        return std::nullopt;
      }
    }
    return opcua::Identity{std::move(*key), std::move(*certificate)};
  } catch (const std::runtime_error& failure) {
    problem = failure.what();
    return std::nullopt;
  }
}

opcua::TrustList Pki::trust_list(std::vector<std::string>& passed_over) const {
  opcua::TrustList list;
  read_all(fs::path(folder_) / "trusted/certs", list.trusted, passed_over);
  read_all(fs::path(folder_) / "issuers/certs", list.issuers, passed_over);
  read_all(fs::path(folder_) / "trusted/crl", list.revoked, passed_over);
  read_all(fs::path(folder_) / "issuers/crl", list.revoked, passed_over);
  return list;
}

bool Pki::has_changed(std::int64_t& stamp) const {
  std::int64_t now = 0;
  for (const char* const each : folders) {
    struct stat status = {};
    if (std::string_view(each) != "rejected" && ::stat((fs::path(folder_) / each).c_str(), &status) == 0)
      now += status.st_mtim.tv_sec * 1'000'000'007 + status.st_mtim.tv_nsec;
  }
  const bool is_other = now != stamp;
  stamp = now;
  return is_other;
}

void Pki::keep_rejected(const security::Certificate& certificate, const std::string& host) {
  const fs::path folder = fs::path(folder_) / "rejected";
  const std::string name = hexadecimal(certificate.thumbprint()) + ".der";
  std::error_code error;
  if (fs::exists(folder / name, error)) return;
  std::vector<std::tuple<fs::file_time_type, std::string>> kept;
  for (const fs::directory_entry& each : fs::directory_iterator(folder, error))
    kept.emplace_back(each.last_write_time(error), each.path().filename().string());
  std::sort(kept.begin(), kept.end());
  std::erase_if(rejected_of_, [&](const auto& each) { return !fs::exists(folder / each.first, error); });
  while (kept.size() >= most_rejected) {
    std::map<std::string, std::size_t> of_host;
    for (const auto& each : kept) ++of_host[rejected_of_[std::get<1>(each)]];
    const auto most = std::max_element(of_host.begin(), of_host.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    const auto oldest = std::find_if(kept.begin(), kept.end(),
                                     [&](const auto& each) { return rejected_of_[std::get<1>(each)] == most->first; });
    rejected_of_.erase(std::get<1>(*oldest));
    if (!fs::remove(folder / std::get<1>(*oldest), error)) return;
    kept.erase(oldest);
  }
  if (write_file(folder / name, certificate.der(), 0644, Durability::whenever)) rejected_of_[name] = host;
}

std::string application_uri_of(const Config& config) {
  return config.server && config.server->application_uri ? *config.server->application_uri : "urn:takt:" + config.node;
}

std::string pki_folder(const Config& config, const std::optional<std::string>& named, const std::string& folder) {
  if (named) return *named;
  if (config.server && config.server->pki) return *config.server->pki;
  return (folder.empty() ? "" : folder + "/") + config.node + "-pki";
}

std::optional<opcua::Identity> own_identity(const Config& config, const std::optional<std::string>& named,
                                            const std::string& folder, security::RandomOctets& random,
                                            std::string& problem) {
  security::OwnCertificate own;
  own.application_uri = application_uri_of(config);
  own.common_name = "takt node " + config.node;
  own.dns_names = {"localhost"};
  const auto address = config.server ? parse_endpoint(config.server->endpoint) : std::nullopt;
  if (address && address->address != "0.0.0.0") own.addresses = {address->address};
  own.valid_from = opcua::seconds_since_1970(utc_now()) - 60;  // clocks of others are not quite ours
  return Pki(pki_folder(config, named, folder)).identity(own, random, problem);
}

}  // namespace takt::node
