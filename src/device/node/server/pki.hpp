// SPDX-License-Identifier: Apache-2.0
// The folder of a server's own key and certificate and of those whom it trusts, as other tools lay it out.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "node/config.hpp"
#include "opcua/channel/trust_list.hpp"
#include "opcua/server/outside.hpp"
#include "security/random.hpp"

namespace takt::node {

class Pki {
 public:
  explicit Pki(std::string folder) : folder_(std::move(folder)) {}

  /// Makes the folders, and at the first start a key, which only its owner may read, and a certificate for ten years.
  /// Nothing, and `problem` says why, if that cannot be, or if others may read the key.
  std::optional<opcua::Identity> identity(const security::OwnCertificate& of, security::RandomOctets& random,
                                          std::string& problem) const;
  /// trusted/certs, trusted/crl, issuers/certs, issuers/crl; DER or PEM. What is none of these, and what others than
  /// its owner may write or belongs to another user, is passed over, and told.
  opcua::TrustList trust_list(std::vector<std::string>& passed_over) const;
  /// Whether what `trust_list` gives may have changed since `stamp`, which is set to now's.
  bool has_changed(std::int64_t& stamp) const;
  /// Keeps a certificate in rejected/, so that it can be moved to trusted/certs; at most so many. Then the oldest goes
  /// of the host that most of them are of; those that were there before this process are of nobody.
  void keep_rejected(const security::Certificate& certificate, const std::string& host);
  static constexpr std::size_t most_rejected = 64;

  const std::string& folder() const { return folder_; }

 private:
  std::string folder_;
  std::map<std::string, std::string> rejected_of_;  ///< hosts, by the names of the files
};

/// Who a node is to others, as a server and as a client: the URI in its certificate.
std::string application_uri_of(const Config& config);
/// `named`, that of the node's server, or NODE-pki in the folder of its file.
std::string pki_folder(const Config& config, const std::optional<std::string>& named, const std::string& folder);
/// Key and certificate of the node in that folder.
std::optional<opcua::Identity> own_identity(const Config& config, const std::optional<std::string>& named,
                                            const std::string& folder, security::RandomOctets& random,
                                            std::string& problem);

}  // namespace takt::node
