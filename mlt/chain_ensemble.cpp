// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/chain_ensemble.h"

namespace fogbow {

void ChainRecord::serialize(std::ostream& out) const {
  write_binary(out, bridge);
  write_binary_vector(out, length_share);
  write_binary_vector(out, length_squares);
  classes.serialize(out);
}

ChainRecord ChainRecord::deserialize(std::istream& in) {
  ChainRecord record;
  record.bridge = read_binary<BridgeSums>(in);
  record.length_share = read_binary_vector<double>(in, 1 << 20);
  record.length_squares = read_binary_vector<double>(in, 1 << 20);
  record.classes = ClassTally::deserialize(in);
  record.of_state_.resize(record.length_share.size());
  return record;
}

}  // namespace fogbow
