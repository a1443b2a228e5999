// SPDX-License-Identifier: Apache-2.0
#include "security/openssl_handles.hpp"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/evp.h>

namespace takt::security::detail {

void DropHandle::operator()(evp_pkey_ctx_st* context) const { EVP_PKEY_CTX_free(context); }
void DropHandle::operator()(evp_md_ctx_st* context) const { EVP_MD_CTX_free(context); }
void DropHandle::operator()(bio_st* bio) const { BIO_free_all(bio); }
ForgetErrors::~ForgetErrors() { ERR_clear_error(); }

Bio bio_of(std::string_view text) { return Bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size()))); }

std::string text_in(bio_st* bio) {
  char* text = nullptr;
  const long size = BIO_get_mem_data(bio, &text);
  return {text, static_cast<std::size_t>(size)};
}

}  // namespace takt::security::detail
