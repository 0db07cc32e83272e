#include "littoral/base/task.h"
int main() { return 0; }
