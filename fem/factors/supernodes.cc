#include "fem/factors/supernodes.h"

#include <suitesparse/cholmod.h>

#include <memory>
#include <new>
#include <stdexcept>
#include <string>

namespace vibrissa::fem {

namespace {

/// State of CHOLMOD.
struct Cholmod {
  Cholmod() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_METIS;
    // In nodes of three unknowns each.
    common.nrelax[0] = 2;
    common.nrelax[1] = 8;
    common.nrelax[2] = 24;
  }
  ~Cholmod() { cholmod_finish(&common); }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;
  cholmod_common common;
};

template <class To>
std::vector<To> copied(const void* values, const std::size_t n) {
  const auto* const begin = static_cast<const int*>(values);
  return {begin, begin + n};
}

}  // namespace

Supernodes::Supernodes(const std::vector<int>& pattern_start, const std::vector<int>& columns) {
  const std::size_t n = pattern_start.size() - 1;
  Cholmod cholmod;
  cholmod_sparse pattern{};
  pattern.nrow = pattern.ncol = n;
  pattern.nzmax = columns.size();
  pattern.p = const_cast<int*>(pattern_start.data());
  pattern.i = const_cast<int*>(columns.data());
  pattern.stype = -1;  // CHOLMOD stores columns: our rows of the upper triangle are its lower one's
  pattern.itype = CHOLMOD_INT;
  pattern.xtype = CHOLMOD_PATTERN;
  pattern.dtype = CHOLMOD_DOUBLE;
  pattern.sorted = pattern.packed = 1;
  const auto free_factor = [&](cholmod_factor* f) { cholmod_free_factor(&f, &cholmod.common); };
  const std::unique_ptr<cholmod_factor, decltype(free_factor)> factor(
      cholmod_analyze(&pattern, &cholmod.common), free_factor);
  if (cholmod.common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  if (!factor || cholmod.common.status < 0 || !factor->is_super) {
    throw std::runtime_error("cholmod_analyze failed with status " +
                             std::to_string(cholmod.common.status));
  }
  const std::size_t n_supernodes = factor->nsuper;
  order = copied<int>(factor->Perm, n);
  first = copied<int>(factor->super, n_supernodes + 1);
  start = copied<std::size_t>(factor->pi, n_supernodes + 1);
  rows = copied<int>(factor->s, start.back());

  of_column.resize(n);
  parent.assign(n_supernodes, -1);
  children.resize(n_supernodes);
  for (std::size_t s = 0; s < n_supernodes; ++s) {
    for (int c = first[s]; c < first[s + 1]; ++c)
      of_column[static_cast<std::size_t>(c)] = static_cast<int>(s);
  }
  for (std::size_t s = 0; s < n_supernodes; ++s) {
    if (n_below(s) == 0) continue;
    parent[s] = of_column[static_cast<std::size_t>(*below(s))];
    children[static_cast<std::size_t>(parent[s])].push_back(s);
  }
}

}  // namespace vibrissa::fem
