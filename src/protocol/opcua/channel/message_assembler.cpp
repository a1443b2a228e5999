// SPDX-License-Identifier: Apache-2.0
#include "opcua/channel/message_assembler.hpp"

namespace takt::opcua {

MessageAssembler::Verdict MessageAssembler::take(const OpenedChunk& chunk, std::size_t most_octets,
                                                 std::size_t most_chunks) {
  if (chunks_ == 0) collected_.clear();
  if (chunks_ != 0 && chunk.sequence.request_id != request_id_) return Verdict::mixed;
  if (chunk.kind == ChunkKind::Abort) {
    chunks_ = 0;
    collected_.clear();
    return Verdict::dropped;
  }
  if (chunks_ + 1 > most_chunks || collected_.size() + chunk.body.size() > most_octets) return Verdict::too_large;
  request_id_ = chunk.sequence.request_id;
  collected_.insert(collected_.end(), chunk.body.begin(), chunk.body.end());
  ++chunks_;
  if (chunk.kind == ChunkKind::Intermediate) return Verdict::more;
  chunks_ = 0;
  return Verdict::complete;
}

}  // namespace takt::opcua
