"""Pictures. Every function takes numbers and returns a matplotlib Figure or its bytes; none computes K."""
