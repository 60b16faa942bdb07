// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/chain_ensemble.h"

namespace fogbow {

void ChainRecord::serialize(std::ostream& out) const {
  write_binary(out, independent_f_star);
  write_binary(out, independent_squares);
  write_binary(out, independent_steps);
  write_binary_vector(out, length_share);
  write_binary_vector(out, length_squares);
  classes.serialize(out);
}

ChainRecord ChainRecord::deserialize(std::istream& in) {
  ChainRecord record;
  record.independent_f_star = read_binary<double>(in);
  record.independent_squares = read_binary<double>(in);
  record.independent_steps = read_binary<std::uint64_t>(in);
  record.length_share = read_binary_vector<double>(in, 1 << 20);
  record.length_squares = read_binary_vector<double>(in, 1 << 20);
  record.classes = ClassTally::deserialize(in);
  record.of_state_.resize(record.length_share.size());
  return record;
}

}  // namespace fogbow
