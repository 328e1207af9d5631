// Invocations of a group of the passes that march; list lengths become numbers of groups.
const MARCH_GROUP: u32 = 64u;
