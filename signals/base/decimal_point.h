#pragma once

#include <locale.h>

namespace vibrissa::signals {

/// During its lifetime the C library reads and writes the numbers of this thread with a decimal
/// point, whatever locale the host program has set. Libraries such as UDUNITS, deal.II and matio
/// depend on it. Proven by tests/python/module_test.py.
class DecimalPoint {
 public:
  DecimalPoint()
      : plain_(::newlocale(LC_NUMERIC_MASK, "C", ::duplocale(::uselocale(nullptr)))),
        before_(::uselocale(plain_)) {}
  ~DecimalPoint() {
    ::uselocale(before_);
    if (plain_ != nullptr) ::freelocale(plain_);
  }
  DecimalPoint(const DecimalPoint&) = delete;
  DecimalPoint& operator=(const DecimalPoint&) = delete;

 private:
  ::locale_t plain_, before_;
};

}  // namespace vibrissa::signals
