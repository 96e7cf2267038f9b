mark(0). mark(1). mark(2). mark(3). mark(4). mark(5). mark(6). mark(7). mark(8). mark(9).
mark(10). mark(11). mark(12). mark(13). mark(14). mark(15). mark(16). mark(17). mark(18). mark(19).
mark(20). mark(21). mark(22). mark(23). mark(24). mark(25). mark(26). mark(27). mark(28). mark(29).
mark(30). mark(31). mark(32). mark(33). mark(34). mark(35). mark(36). mark(37). mark(38). mark(39).
mark(40). mark(41). mark(42). mark(43). mark(44). mark(45). mark(46). mark(47). mark(48). mark(49).
mark(50). mark(51). mark(52). mark(53). mark(54). mark(55). mark(56). mark(57). mark(58). mark(59).
mark(60). mark(61). mark(62). mark(63). mark(64). mark(65). mark(66). mark(67). mark(68). mark(69).
mark(70). mark(71). mark(72). mark(73). mark(74). mark(75). mark(76). mark(77). mark(78). mark(79).
mark(80). mark(81). mark(82). mark(83). mark(84). mark(85). mark(86). mark(87). mark(88). mark(89).
mark(90). mark(91). mark(92). mark(93). mark(94). mark(95). mark(96). mark(97). mark(98). mark(99).
mark(100). mark(101). mark(102). mark(103). mark(104). mark(105). mark(106). mark(107). mark(108). mark(109).
mark(110). mark(111). mark(112). mark(113). mark(114). mark(115). mark(116). mark(117). mark(118). mark(119).
mark(120). mark(121). mark(122). mark(123). mark(124). mark(125). mark(126). mark(127). mark(128). mark(129).
+mark(N) <- .print(N).
!drive.
+!drive <- wait; !drive.
