#include "verify/bounds.hpp"

namespace takt::verify {

std::vector<Proved> prove(const scenario::Resolved&, const std::vector<results::RequirementResult>& requirements, const ProofOptions&) {
  std::vector<Proved> proofs(requirements.size());
  for (Proved& proved : proofs) proved.reason = "no bound";
  return proofs;
}

}  // namespace takt::verify
