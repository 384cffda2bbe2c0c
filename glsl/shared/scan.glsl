const uint SCAN_GROUP = 256u;   // threads a group in the prefix sums
