#include "base/format.h"

#include <iostream>

int main() { std::cout << "after 2 s the bob is at " << sprung::format_number(0.5) << '\n'; }
